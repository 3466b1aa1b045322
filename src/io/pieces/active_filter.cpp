// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/pieces/active_filter.hpp"

#include <isotet/grid.hpp>

namespace isotet::io {

std::optional<ActiveCellFilter> active_filter(const Grid& grid, std::optional<CellType> type,
                                              const ReadOptions& options) {
    if (!options.active_cells || !grid.cell_fields.empty() || !options.displace.empty()) return std::nullopt;
    if (may_have_coincident_points(grid.points)) return std::nullopt;
    const auto& shape = options.active_cells->shape;
    const auto field = shape ? slice_field(grid.points, *shape) : find_field(grid, options.active_cells->field);
    if (!field) return std::nullopt;
    DirectOptions direct = options.active_cells->options;
    direct.extract.point_fields = grid.point_fields;
    auto filter = ActiveCellFilter::create(grid.points, *field, options.active_cells->isovalues, type, direct);
    if (!filter) return std::nullopt; // reading all cells tells what is wrong
    return *std::move(filter);
}

} // namespace isotet::io
