// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/extract.hpp>

#include <cmath>

#include <fmt/format.h>

#include "api/attributes.hpp"
#include "api/ties.hpp"
#include "core/guard.hpp"
#include "core/packed.hpp"
#include "core/parallel.hpp"
#include "core/storage.hpp"
#include "cpu/extract.hpp"
#include "reference/extract.hpp"

namespace isotet {

namespace {

Result<void> check_options(const PackedGrid& packed, double isovalue, const ExtractOptions& options) {
    const auto wrong = [](std::string message) { return Error{ErrorCode::invalid_argument, std::move(message)}; };
    const core::Packed& data = packed.data();
    if (!std::isfinite(isovalue)) return wrong(fmt::format("the isovalue is {}, but must be finite", isovalue));
    if (options.normals == Normals::gradient && data.gradients.empty() && data.points() != 0)
        return wrong("gradient normals need a grid that was packed with gradients, but this one was not");
    if ((options.source_cells || !options.cell_fields.empty()) && !data.has_cell_ids() && data.clusters() != 0)
        return wrong("source cells and cell fields need a grid that was packed with source cells, but this one was not");
    for (const Field& field : options.point_fields)
        if (field.values.tuples() != data.user_points)
            return wrong(fmt::format("point field '{}' has {} tuples, but the packed grid has {} points", field.name,
                                     field.values.tuples(), data.user_points));
    for (const Field& field : options.cell_fields)
        if (field.values.tuples() != data.user_cells)
            return wrong(fmt::format("cell field '{}' has {} tuples, but the packed grid has {} cells", field.name,
                                     field.values.tuples(), data.user_cells));
    return {};
}

template <class Real>
Result<Extraction> extract_as(const core::Packed& packed, double isovalue, const ExtractOptions& options,
                              const Progress& progress) {
    ops::Request<Real> request{core::store_isovalue<Real>(isovalue, packed.storage)};
    request.ties = options.ties;
    request.ends = options.edge_ends || !options.point_fields.empty();
    request.normals = options.normals == Normals::gradient;
    request.source_cells = options.source_cells || !options.cell_fields.empty();

    auto raw = options.engine == Engine::reference ? reference::extract(packed, request, progress)
                                                   : cpu::extract(packed, request, progress);
    if (!raw) return std::move(raw).error();
    progress("extract", 0.8);

    Extraction out;
    Surface& surface = out.surface;
    surface.origin = packed.origin;
    surface.positions = raw->positions;
    surface.triangles = raw->triangles;
    surface.normals_kind = options.normals;
    if (options.normals == Normals::gradient) surface.normals = api::fill_normals<Real>(*raw);
    else if (options.normals == Normals::face) surface.normals = api::face_normals<Real>(*raw);
    for (const Field& field : options.point_fields)
        surface.point_fields.push_back(api::interpolate_field<Real>(field, packed, *raw));
    for (const Field& field : options.cell_fields) surface.cell_fields.push_back(api::copy_cell_field(field, *raw));
    if (options.edge_ends) {
        surface.edge_ends = raw->ends;
        surface.edge_weights = raw->weights;
    }
    if (options.source_cells) surface.source_cells = raw->source_cells;

    api::count_ties(packed, isovalue, request.isovalue, out.report);
    out.report.selected_clusters = raw->selected_clusters;
    out.report.transient_bytes = raw->transient_bytes;
    progress("extract", 1);
    return out;
}

} // namespace

Result<Extraction> extract(const PackedGrid& packed, double isovalue, const ExtractOptions& options, const Progress& progress) {
    return core::guarded("extraction", [&]() -> Result<Extraction> {
        if (auto ok = check_options(packed, isovalue, options); !ok) return ok.error();
        Result<Extraction> result = Error{};
        core::with_threads(options.threads, [&] {
            result = packed.data().single() ? extract_as<float>(packed.data(), isovalue, options, progress)
                                            : extract_as<double>(packed.data(), isovalue, options, progress);
        });
        return result;
    });
}

} // namespace isotet
