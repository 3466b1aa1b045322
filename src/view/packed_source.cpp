// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "view/packed_source.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <isotet/boundary.hpp>
#include <isotet/contour.hpp>

namespace isotet::view {

bool same_points(const PackedFileInfo& file, std::size_t one, std::size_t other) {
    const auto [first, last] = std::minmax(one, other);
    return std::ranges::none_of(
        file.moved_points, [&](const PackedPointsInfo& points) { return points.step > first && points.step <= last; });
}

bool PackedSource::has(const std::string& field, std::size_t step) const {
    return file_ && std::ranges::any_of(file_->info().fields, [&](const PackedFieldInfo& one) {
               return one.step == step && one.report.name == field;
           });
}

/// All arrays in memory, of any field.
Result<PackedGrid> PackedSource::whole(std::size_t step, const Run& run) {
    if (!file_) return *packed_;
    if (!whole_ || !same_points(file_->info(), step, whole_step_)) {
        whole_.reset();
        const auto& fields = file_->info().fields;
        const auto any = std::ranges::find(fields, step, &PackedFieldInfo::step);
        Result<PackedGrid> loaded = file_->load(any == fields.end() ? std::string() : any->report.name, step, run);
        if (!loaded) return loaded;
        whole_ = *std::move(loaded);
        whole_step_ = step;
    }
    return *whole_;
}

Result<PackedGrid> PackedSource::grid_of(const PointField& field, std::size_t step, const Run& run) {
    if (packed_ && field.name == field_.name && field.values.data() == field_.values.data()) return *packed_;
    Result<PackedGrid> changed = Error{};
    if (has(field.name, step)) changed = file_->grid(field.name, step, run);
    else {
        const Result<PackedGrid> all = whole(step, run);
        if (!all) return all;
        changed = all->with_field(field, run);
    }
    if (!changed) return changed;
    packed_ = *changed;
    field_ = field;
    return changed;
}

/// Fields of the file in place of the arrays of all its points, which would bring all of it in.
Result<ExtractOptions> PackedSource::with_packed_fields(ExtractOptions options, std::size_t step,
                                                        const Run& run) const {
    std::vector<Field> others;
    for (Field& field : options.point_fields) {
        if (!has(field.name, step)) {
            others.push_back(std::move(field));
            continue;
        }
        Result<PackedGrid> packed = file_->grid(field.name, step, run);
        if (!packed) return packed.error();
        options.packed_fields.push_back(*std::move(packed));
    }
    options.point_fields = std::move(others);
    return options;
}

Result<Surface> PackedSource::isosurface(const PointField& field, std::size_t step, double isovalue,
                                         const ExtractOptions& options, const Run& run) {
    const Result<PackedGrid> packed = grid_of(field, step, run);
    if (!packed) return packed.error();
    const bool of_file = has(field.name, step);
    const auto carried = of_file ? with_packed_fields(options, step, run) : Result<ExtractOptions>(options);
    if (!carried) return carried.error();
    const auto grid = engine_->create_grid(*packed, run);
    if (!grid) return grid.error();
    Result<std::vector<Extraction>> extracted = (*grid)->extract({&isovalue, 1}, *carried, run);
    if (!extracted) return extracted.error();
    return std::move(extracted->front().surface);
}

Result<Surface> PackedSource::boundary(std::size_t step, const Run& run) {
    if (!file_) return boundary_of(*packed_, run);
    const auto& fields = file_->info().fields;
    const auto any = std::ranges::find(fields, step, &PackedFieldInfo::step);
    const Result<PackedGrid> grid = file_->grid(any == fields.end() ? std::string() : any->report.name, step, run);
    if (!grid) return grid.error();
    return boundary_of(*grid, run);
}

Result<PackedGrid> PackedSource::sliced(const Plane& plane, std::size_t step, const Run& run) {
    const bool is_known = sliced_ && plane_.normal == plane.normal && same_points(file_->info(), step, sliced_step_);
    if (is_known) return *sliced_;
    sliced_.reset();
    Result<PackedGrid> heights = file_->sliced(plane, step, run);
    if (heights) sliced_ = *heights;
    plane_ = plane;
    sliced_step_ = step;
    return heights;
}

Result<Surface> PackedSource::slice(const Array& points, const Plane& plane, std::size_t step,
                                    const ExtractOptions& options, const Run& run) {
    Result<PackedGrid> heights = Error{};
    Result<ExtractOptions> carried = options;
    if (file_) {
        heights = sliced(plane, step, run);
        if (heights) carried = with_packed_fields(options, step, run);
    } else {
        const Result<PointField> field = slice_field(points, plane, run);
        if (!field) return field.error();
        heights = packed_->with_field(*field, run);
    }
    if (!heights) return heights.error();
    if (!carried) return carried.error();
    Result<Extraction> extracted = extract(*heights, plane.offset, *carried, run);
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
