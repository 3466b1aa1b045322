// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// How fast this machine copies memory: what the share of every method is measured against.
#pragma once

namespace isotet::bench {

/// Bytes a second, read and written ones both counted, of copying arrays far larger than any cache on `threads`
/// threads: the best of a few passes.
double copy_bandwidth(int threads);

} // namespace isotet::bench
