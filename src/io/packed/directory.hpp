// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Header and directory of a packed file as bytes, and back.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include <isotet/result.hpp>

#include "io/packed/format.hpp"

namespace isotet::io {

std::vector<std::byte> encode_directory(const PackedDirectory& directory);

/// Errors   invalid_data: what does not fit together, or into a file of `file_bytes`; nothing is taken on trust
Result<PackedDirectory> decode_directory(std::span<const std::byte> bytes, std::uint64_t file_bytes);

/// The first bytes of the file, without slots.
std::array<std::byte, packed_header_bytes> encode_packed_header();
std::array<std::byte, packed_slot_bytes> encode_slot(const DirectorySlot& slot);

/// The slot that holds. `place`   null, or becomes 0 for the first one, 1 for the second
/// Errors   invalid_data: no packed file, another byte order, a newer major version, both slots broken, or a file that ends
///          before the slot says
Result<DirectorySlot> decode_packed_header(std::span<const std::byte> bytes, std::uint64_t file_bytes,
                                           std::size_t* place = nullptr);

} // namespace isotet::io
