// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/pieces/active_filter.hpp"

#include <utility>

#include <isotet/fields.hpp>
#include <isotet/grid.hpp>

namespace isotet::io {

Result<PointField> active_field(const Grid& grid, const ReadActiveCells& active) {
    return active.shape ? slice_field(grid.points, *active.shape) : find_field(grid, active.field);
}

std::optional<ActiveCellFilter> active_filter(const Grid& grid, std::optional<CellType> type,
                                              const ReadOptions& options, bool numbers,
                                              std::vector<double>& isovalues) {
    if (!options.active_cells || !options.displace.empty()) return std::nullopt;
    if (may_have_coincident_points(grid.points)) return std::nullopt;
    const ReadActiveCells& active = *options.active_cells;
    const auto field = active_field(grid, active);
    if (!field) return std::nullopt;
    DirectOptions direct = active.options;
    direct.extract.point_fields = grid.point_fields;
    direct.extract.source_cells = numbers;
    isovalues = active.isovalues;
    if (isovalues.empty() && active.choose) {
        auto chosen = active.choose(*field);
        if (!chosen) return std::nullopt;
        isovalues = *std::move(chosen);
    }
    auto filter = ActiveCellFilter::create(grid.points, *field, isovalues, type, direct);
    if (!filter) return std::nullopt; // reading all cells tells what is wrong
    return *std::move(filter);
}

} // namespace isotet::io
