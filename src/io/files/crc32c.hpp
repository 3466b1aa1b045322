// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <isotet/export.hpp>

namespace isotet::io {

/// CRC-32C (Castagnoli; RFC 3720) of bytes, or of several runs of them one after another.
/// `before`   of the runs before
/// Cost       about 10 GB/s where the processor has an instruction for it, 1 GB/s elsewhere
ISOTET_API std::uint32_t crc32c(std::span<const std::byte> bytes, std::uint32_t before = 0) noexcept;

/// The same without the instruction, for tests.
ISOTET_API std::uint32_t portable_crc32c(std::span<const std::byte> bytes, std::uint32_t before = 0) noexcept;

} // namespace isotet::io
