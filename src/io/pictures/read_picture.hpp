// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

#include <isotet/picture.hpp>

namespace isotet::io {

/// read_picture() of a file whose bytes are at hand.
///
/// `name`     of the file, for messages
/// Errors     invalid_data when it is no PNG file, or too short for a picture of the size that it tells; out_of_memory,
///            before memory is taken
Result<Picture> parse_picture(std::string_view bytes, const std::string& name);

} // namespace isotet::io
