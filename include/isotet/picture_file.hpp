// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Pictures in files; part of isotet::io.
#pragma once

#include <cstdint>
#include <string>

#include <isotet/export.hpp>
#include <isotet/picture.hpp>
#include <isotet/result.hpp>

namespace isotet {

/// Writes a PNG file, with an alpha channel only where the picture is not opaque. Written beside and renamed, as all
/// files.
///
/// Guarantees   the same bytes for the same picture (and version of libdeflate)
/// Errors       invalid_argument when the ending is not .png, or the picture has no pixels; file, cannot_write as
///              write_surface()
ISOTET_API Result<std::uint64_t> write_picture(const Picture& picture, const std::string& path);

/// Reads a PNG file of any kind as 8 bits a part.
///
/// Errors   file: not there; invalid_data: no PNG, broken, or of more than 32768 x 32768 pixels
ISOTET_API Result<Picture> read_picture(const std::string& path);

} // namespace isotet
