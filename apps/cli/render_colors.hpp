// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// --color-by: the field that colours, and its scale.
#pragma once

#include <isotet/grid.hpp>
#include <isotet/result.hpp>
#include <isotet/surface.hpp>

#include "console.hpp"
#include "options.hpp"
#include "render_input.hpp"

namespace isotet::cli {

/// The smallest and the largest value that has a colour on the scale of `command`; lower > upper: there is none.
ValueRange range_of(const Array& values, const RenderCommand& command);

/// A field of the grid: a point field or a component of one, a cell field as it is, otherwise what find_field() makes
/// of the name. A cell field of at most twelve whole numbers has a colour for each, unless --range or --log is given.
/// Errors   invalid_argument: no such field; it has several components; --range is no range, or does not fit --log
Result<ColorField> colors_of(const Grid& grid, const std::string& name, const RenderCommand& command, Console& console);

/// A field of a surface, point fields first; components by `:x`, `:mag` and so on of point fields.
Result<ColorField> colors_of(const Surface& surface, const RenderCommand& command, Console& console);

} // namespace isotet::cli
