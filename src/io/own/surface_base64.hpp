// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Base64, as VTK's files have it: streams with or without padding, one after another.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace isotet::io {

/// Decodes from the start of `text` until `most` bytes are there or a character comes that is neither base64 nor space.
/// A padded group ends a stream; the next one may follow at once.
///
/// Returns   nothing if a group of four is broken
std::optional<std::string> decode_base64(std::string_view text, std::size_t most);

} // namespace isotet::io
