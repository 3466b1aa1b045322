// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "view/packed_source.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <isotet/boundary.hpp>
#include <isotet/contour.hpp>

namespace isotet::view {

/// All arrays in memory, of any field.
Result<PackedGrid> PackedSource::whole(const Run& run) {
    if (!file_) return *packed_;
    if (!whole_) {
        Result<PackedGrid> loaded = file_->load(file_->info().fields.front().report.name, 0, run);
        if (!loaded) return loaded;
        whole_ = *std::move(loaded);
    }
    return *whole_;
}

Result<PackedGrid> PackedSource::grid_of(const PointField& field, std::size_t step, const Run& run) {
    if (packed_ && field.name == field_.name && field.values.data() == field_.values.data()) return *packed_;
    const auto is_it = [&](const PackedFieldInfo& one) { return one.step == step && one.report.name == field.name; };
    Result<PackedGrid> changed = Error{};
    if (file_ && std::ranges::any_of(file_->info().fields, is_it)) changed = file_->grid(field.name, step, run);
    else {
        const Result<PackedGrid> all = whole(run);
        if (!all) return all;
        changed = all->with_field(field, run);
    }
    if (!changed) return changed;
    packed_ = *changed;
    field_ = field;
    return changed;
}

Result<Surface> PackedSource::isosurface(const PointField& field, std::size_t step, double isovalue,
                                         const ExtractOptions& options, const Run& run) {
    const Result<PackedGrid> packed = grid_of(field, step, run);
    if (!packed) return packed.error();
    Result<Extraction> extracted = extract(*packed, isovalue, options, run);
    if (!extracted) return extracted.error();
    return std::move(extracted->surface);
}

Result<Surface> PackedSource::boundary(const Run& run) {
    if (!file_) return boundary_of(*packed_, run);
    const Result<PackedGrid> grid = file_->grid(file_->info().fields.front().report.name, 0, run);
    if (!grid) return grid.error();
    return boundary_of(*grid, run);
}

Result<Surface> PackedSource::slice(const Array& points, const Plane& plane, const ExtractOptions& options,
                                    const Run& run) {
    const Result<PointField> field = slice_field(points, plane, run);
    if (!field) return field.error();
    const Result<PackedGrid> all = whole(run);
    if (!all) return all.error();
    const Result<PackedGrid> heights = all->with_field(*field, run);
    if (!heights) return heights.error();
    Result<Extraction> extracted = extract(*heights, plane.offset, options, run);
    if (!extracted) return extracted.error();
    return std::move(extracted->surface);
}

CellSample sample_of_cells(const Grid& grid) {
    const Cells& cells = grid.cells;
    const std::uint64_t count = cells.count(), taken = FieldSample::max_cells;
    CellSample sample{{grid.points, {}, {}, {}}, 1};
    if (count <= taken) {
        sample.grid.cells = cells;
        return sample;
    }
    sample.cells_each = static_cast<double>(count) / static_cast<double>(taken);
    const std::uint64_t corners_each = cells.offsets.empty() ? cells.connectivity.size() / count : 0;
    std::vector<std::int64_t> connectivity, offsets{0};
    std::vector<std::uint8_t> types;
    for (std::uint64_t i = 0; i < taken; ++i) {
        // Regular grids repeat themselves: places between even steps are drawn (Weyl's sequence).
        const double drawn = std::fmod(static_cast<double>(i) * 0.618033988749895, 1.0);
        const auto cell =
            std::min(count - 1, static_cast<std::uint64_t>((static_cast<double>(i) + drawn) * sample.cells_each));
        const auto offset = [&](std::uint64_t which) {
            return corners_each > 0 ? which * corners_each : static_cast<std::uint64_t>(cells.offsets.at(which));
        };
        for (std::uint64_t at = offset(cell); at < offset(cell + 1); ++at)
            connectivity.push_back(static_cast<std::int64_t>(cells.connectivity.at(at)));
        offsets.push_back(static_cast<std::int64_t>(connectivity.size()));
        types.push_back(cells.types.empty() ? static_cast<std::uint8_t>(cells.uniform_type)
                                            : static_cast<std::uint8_t>(cells.types.at(cell)));
    }
    sample.grid.cells.connectivity = Array::own(std::move(connectivity));
    sample.grid.cells.offsets = Array::own(std::move(offsets));
    sample.grid.cells.types = Array::own(std::move(types));
    return sample;
}

} // namespace isotet::view
