// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <isotet/export.hpp>
#include <isotet/picture.hpp>
#include <isotet/result.hpp>

namespace isotet {

/// The share of pixels, 0 to 1, that differ visibly: in some part by more than `tolerance` of 255. Where nothing can be
/// seen in either picture, colours do not count.
///
/// Errors   invalid_argument when the pictures have different sizes
ISOTET_API Result<double> difference(const Picture& a, const Picture& b, int tolerance = 12);

} // namespace isotet
