// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The compressors of VTK's XML files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <isotet/export.hpp>

namespace isotet::io::vtk_xml {

enum class Codec : std::uint8_t { none, zlib, lz4, lzma };

/// By the name of VTK's class ("vtkZLibDataCompressor"); empty: none.
std::optional<Codec> codec_of(std::string_view compressor);

std::string_view name_of(Codec codec);

/// False where so few bytes cannot become so many.
ISOTET_API bool is_plausible(Codec codec, std::uint64_t packed, std::uint64_t unpacked);

/// Packs one block, by zlib or LZ4: fast rather than small.
ISOTET_API std::string deflate(Codec codec, std::span<const std::byte> block);

/// Whether blocks end with a checksum of their values.
constexpr bool has_checksum(Codec codec) { return codec == Codec::zlib; }
constexpr std::size_t checksum_bytes = 4;

/// As zlib stores it: Adler-32, the highest byte first.
std::string checksum_of(std::span<const std::byte> values);

/// Inflates one block, which must fill `to`.
ISOTET_API bool inflate(Codec codec, std::string_view packed, std::span<std::byte> to);

} // namespace isotet::io::vtk_xml
