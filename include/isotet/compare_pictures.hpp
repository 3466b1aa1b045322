// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <isotet/picture.hpp>
#include <isotet/result.hpp>

namespace isotet {

/// Reads a PNG file of any kind as 8 bits a part.
///
/// Errors   file: not there; invalid_data: no PNG, broken, or of more than 32768 x 32768 pixels
Result<Picture> read_picture(const std::string& path);

/// The share of pixels, 0 to 1, that differ visibly: in some part by more than `tolerance` of 255. Where nothing can be
/// seen in either picture, colours do not count.
///
/// Errors   invalid_argument when the pictures have different sizes
Result<double> difference(const Picture& a, const Picture& b, int tolerance = 12);

} // namespace isotet
