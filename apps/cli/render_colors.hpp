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

/// A field of the grid: a point field or a component of one, a cell field as it is, otherwise what find_field() makes
/// of the name.
/// Errors   invalid_argument: no such field; it has several components; --range is no range, or does not fit --log
Result<ColorField> colors_of(const Grid& grid, const RenderCommand& command, Console& console);

/// A field of a surface, point fields first; components by `:x`, `:mag` and so on of point fields.
Result<ColorField> colors_of(const Surface& surface, const RenderCommand& command, Console& console);

} // namespace isotet::cli
