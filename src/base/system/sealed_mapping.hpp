// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// A memory file that cannot change any more, as bytes.
#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include <isotet/export.hpp>
#include <isotet/result.hpp>

namespace isotet::core {

struct SealedMapping {
    std::span<const std::byte> bytes;
    std::shared_ptr<const void> owner; ///< unmapped with its last copy
};

/// Seals a memory file against writing and changes of its size, and maps it.
///
/// The mapping is private: before Linux 6.7 a shared one of a file that is sealed against writing is refused.
///
/// `descriptor`  may be closed afterwards
/// Errors        machine: it cannot be sealed (no memory file, or mapped for writing) or mapped
ISOTET_API Result<SealedMapping> map_sealed(int descriptor);

} // namespace isotet::core
