// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/pieces/active_filter.hpp"

#include <utility>

#include <isotet/fields.hpp>
#include <isotet/grid.hpp>

#include "grid/points/coincident_points.hpp"

namespace isotet::io {

bool may_coincide(const Array& points, std::uint64_t cells) {
    const bool are_cells_apart = points.tuples() > 3 * cells; // so many only where they share next to none
    return core::may_have_doubled_points(points, are_cells_apart);
}

namespace {

bool extracts_none(const ReadActiveCells& active) { return active.field.empty() && !active.shape; }

} // namespace

Result<PointField> active_field(const Grid& grid, const ReadActiveCells& active,
                                const std::optional<PointField>& known) {
    if (known) return *known;
    if (extracts_none(active))
        return PointField{{}, Array::own(std::vector<std::uint8_t>(grid.points.tuples())), false, {}};
    return active.shape ? slice_field(grid.points, *active.shape) : find_field(grid, active.field);
}

std::optional<ActiveCellFilter> active_filter(const Grid& grid, const std::optional<PointField>& known,
                                              std::optional<CellType> type, std::uint64_t cells,
                                              const ReadOptions& options, bool numbers,
                                              std::vector<double>& isovalues) {
    if (!options.active_cells || !options.displace.empty()) return std::nullopt;
    if (may_coincide(grid.points, cells)) return std::nullopt;
    const ReadActiveCells& active = *options.active_cells;
    const auto field = active_field(grid, active, known);
    if (!field) return std::nullopt;
    DirectOptions direct = active.options;
    direct.extract.point_fields = grid.point_fields;
    direct.extract.source_cells = numbers;
    if (extracts_none(active)) isovalues = {1}; // which its zeros do not meet
    else isovalues.insert(isovalues.end(), active.isovalues.begin(), active.isovalues.end());
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
