// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/engine.hpp>
#include <isotet/extract.hpp>

#include <optional>

#include <fmt/core.h>

#include "api/active_cells.hpp"
#include "api/engines.hpp"
#include "api/finish.hpp"
#include "base/array_slot.hpp"
#include "base/carry_out.hpp"
#include "base/errors.hpp"
#include "base/parallel.hpp"
#include "cpu/direct/direct.hpp"
#include "grid/cells.hpp"
#include "grid/grid_size.hpp"
#include "grid/renumber.hpp"
#include "packed/frame.hpp"
#include "reference/direct.hpp"

namespace isotet {

namespace {

/// Fields against the grid.
Result<void> check_fields(const Grid& grid, const PointField& field, const ExtractOptions& options) {
    if (auto ok = api::check_point_fields(grid.points.tuples(), field, options.point_fields); !ok) return ok;
    const std::size_t cells = grid.cells.count();
    for (const Field& carried : options.cell_fields)
        if (carried.values.tuples() != cells)
            return invalid_argument(fmt::format("cell field '{}' has {} tuples, but the grid has {} cells",
                                                carried.name, carried.values.tuples(), cells));
    return {};
}

/// What is extracted from: the user's arrays, or, where points have numbers, copies sorted by these.
struct DirectArrays {
    Grid grid;
    PointField field;
    std::vector<Field> carried;
    core::Buffer<std::uint64_t> original; ///< index -> the user's; empty: they are the user's arrays
};

Result<DirectArrays> arrays_by_number(const Grid& grid, const core::CellReader& cells, const PointField& field,
                                      const std::vector<Field>& carried, const Progress& progress) {
    if (grid.point_numbers.empty()) return DirectArrays{grid, field, carried, {}};
    if (auto ok = core::check_cells(grid, cells, progress); !ok) return ok.error();
    auto sorted = core::sort_points_by_number(grid);
    if (!sorted) return sorted.error();
    DirectArrays out{std::move(sorted->grid), field, carried, std::move(sorted->original)};
    out.field.values = core::in_order(field.values, out.original);
    for (Field& other : out.carried) other.values = core::in_order(other.values, out.original);
    return out;
}

Array user_ends(const Array& ends, const core::Buffer<std::uint64_t>& original) {
    const auto sorted = ends.as<std::int64_t>();
    core::Buffer<std::int64_t> out(sorted.size());
    core::parallel_each(sorted.size(), 1 << 16, [&](std::size_t i) {
        out[i] = static_cast<std::int64_t>(original[static_cast<std::size_t>(sorted[i])]);
    });
    return std::move(out).to_array(2);
}

using api::Kernels;

template <class Real, Kernels kernels>
Result<DirectExtraction> extract_as(const ops::DirectInput& input, const core::Buffer<std::uint64_t>& original,
                                    std::span<const double> isovalues, const DirectOptions& direct,
                                    const Progress& progress) {
    const ExtractOptions& options = direct.extract;
    ops::DirectRequest request;
    request.split_cells = direct.split_cells;
    request.isovalues = isovalues;
    request.ties = options.ties;
    request.ends = options.edge_ends || !options.point_fields.empty();
    request.normals = options.normals == Normals::gradient;
    request.source_cells = options.source_cells || !options.cell_fields.empty();
    request.active_cells_only = direct.active_cells_only;
    std::optional<core::RememberingSink> sink;
    if (options.sink) sink.emplace(options.sink);
    const core::ArraySlots slots = api::slots_of(options, sink ? &*sink : nullptr);
    request.slots = api::slots_for_engine<Real>(slots, {{}, input.grid.points.type()}, options, {});
    auto result = kernels == Kernels::reference ? reference::extract_direct<Real>(input, request, progress)
                                                : cpu::extract_direct<Real>(input, request, progress);
    if (!result) return std::move(result).error();
    progress("extract", 0.8);

    const api::Placement placement{result->origin, input.grid.points.type()};
    DirectExtraction out;
    out.needs_all_cells = result->needs_all_cells;
    out.field = result->field;
    out.cells_left_out = result->cells_left_out;
    for (ops::DirectSurface& surface : result->surfaces) {
        Extraction& extraction = out.surfaces.emplace_back();
        ExtractReport& report = extraction.report;
        if (!original.empty() && !surface.raw.ends.empty()) surface.raw.ends = user_ends(surface.raw.ends, original);
        const std::size_t number = out.surfaces.size() - 1;
        extraction.surface = api::finish<Real>(placement, options, result->carried, surface.raw, slots, number);
        if (sink) sink->bring(extraction.surface, number);
        report.tied_points = surface.raw.tied_points;
        report.false_ties = surface.false_ties;
        report.near_tie = surface.near_tie;
        report.isovalue_stored = surface.isovalue_stored;
        report.surface_bytes = api::bytes_of(extraction.surface);
        report.transient_bytes = result->transient_bytes;
        report.predicted_bytes = result->predicted_bytes;
        out.coarse_tets += surface.coarse_tets;
        surface = {}; // parts that only attributes needed go as soon as they can
    }
    progress("extract", 1);
    return out;
}

} // namespace

template <Kernels kernels>
Result<DirectExtraction> api::extract_direct_by(const Grid& grid, const PointField& field,
                                                std::span<const double> isovalues, const DirectOptions& options,
                                                const Run& run) {
    return core::carry_out("extraction", run, [&](const Progress& progress) -> Result<DirectExtraction> {
        if (auto ok = api::check_isovalues(isovalues); !ok) return ok.error();
        const auto cells = core::CellReader::open(grid);
        if (!cells) return cells.error();
        if (auto ok = check_fields(grid, field, options.extract); !ok) return ok.error();
        if (options.active_cells_only)
            if (auto ok = api::check_active_cells_do(options); !ok) return ok.error();
        if (auto ok = core::find_in_frame(options.frame, field.name, field.values.type()); !ok) return ok.error();
        if (options.frame)
            if (auto ok = core::check_point_type(*options.frame, grid.points.type()); !ok) return ok.error();
        if (auto ok = core::check_grid_size(grid.points, options.precision, options.frame ? &*options.frame : nullptr);
            !ok)
            return ok.error();
        const auto arrays = arrays_by_number(grid, *cells, field, options.extract.point_fields, progress);
        if (!arrays) return arrays.error();
        const auto reader = core::CellReader::open(arrays->grid);
        if (!reader) return reader.error();
        const ops::DirectInput input{arrays->grid, *reader, arrays->field, arrays->carried,
                                     options.frame ? &*options.frame : nullptr};
        return options.precision == Precision::float32
                   ? extract_as<float, kernels>(input, arrays->original, isovalues, options, progress)
                   : extract_as<double, kernels>(input, arrays->original, isovalues, options, progress);
    });
}

template Result<DirectExtraction> api::extract_direct_by<Kernels::cpu>(const Grid&, const PointField&,
                                                                       std::span<const double>, const DirectOptions&,
                                                                       const Run&);
template Result<DirectExtraction> api::extract_direct_by<Kernels::reference>(const Grid&, const PointField&,
                                                                             std::span<const double>,
                                                                             const DirectOptions&, const Run&);

Result<void> api::check_point_fields(std::size_t points, const PointField& field, std::span<const Field> carried) {
    if (field.values.components() != 1 && !field.values.empty())
        return invalid_argument(fmt::format("field '{}' has {} components, but the contoured field must have 1",
                                            field.name, field.values.components()));
    if (field.values.tuples() != points)
        return invalid_argument(fmt::format("field '{}' has {} values, but the grid has {} points", field.name,
                                            field.values.tuples(), points));
    for (const Field& other : carried)
        if (other.values.tuples() != points)
            return invalid_argument(fmt::format("point field '{}' has {} tuples, but the grid has {} points",
                                                other.name, other.values.tuples(), points));
    return {};
}

Result<DirectExtraction> extract_direct(const Grid& grid, const PointField& field, std::span<const double> isovalues,
                                        const DirectOptions& options, const Run& run) {
    return api::extract_direct_by<Kernels::cpu>(grid, field, isovalues, options, run);
}

Result<DirectExtraction> extract_direct_by_reference(const Grid& grid, const PointField& field,
                                                     std::span<const double> isovalues, const DirectOptions& options,
                                                     const Run& run) {
    return api::extract_direct_by<Kernels::reference>(grid, field, isovalues, options, run);
}

} // namespace isotet
