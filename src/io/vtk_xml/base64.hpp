// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Base64 without white space, in groups of four characters.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace isotet::io::vtk_xml {

/// Bytes that the decoder may write, of so many characters.
constexpr std::size_t decoded_room(std::size_t characters) { return characters / 4 * 3 + 32; }

/// Decodes whole groups; the last one may be padded.
///
/// `to`      room for decoded_room() bytes
/// Returns   bytes; nothing where the text is no whole groups of base64, or padded before its end
std::optional<std::size_t> decode_base64(std::string_view text, std::byte* to);

} // namespace isotet::io::vtk_xml
