// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace isotet::core {

/// While one lives, all blocks given back (base/block.hpp) are kept and cut up for whoever wants less: for work in
/// stages, each of which would otherwise touch fresh memory. Kept blocks go before they would raise the peak: then the
/// system gets them back.
///
/// Guarantees   in the end as much is kept as without it
/// Threads      for all threads of the process; several may live
class BlockReuse {
public:
    BlockReuse();
    ~BlockReuse();
    BlockReuse(const BlockReuse&) = delete;
    BlockReuse& operator=(const BlockReuse&) = delete;
};

} // namespace isotet::core
