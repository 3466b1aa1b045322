// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "cpu/extract.hpp"

#include <algorithm>

#include "core/memory.hpp"
#include "cpu/steps.hpp"

namespace isotet::cpu {

namespace {

/// The surface of the one isovalue of the request.
template <class Real>
Result<ops::RawSurfaces> extract_one(const core::Packed& packed, const ops::Request<Real>& request, const Progress& progress) {
    const auto cancelled = [] { return Error{ErrorCode::cancelled, "extraction was cancelled"}; };
    const Selection selection = select(packed, request.isovalues.front());
    Masks masks(packed, selection);
    const Counted counted = count(packed, request, selection, masks, progress);
    if (progress.cancelled()) return cancelled();
    const core::Buffer<Start> starts = scan(counted.counts, masks);
    const Start total = starts[selection.clusters.size()];

    const std::size_t index_bytes = total.vertex < wide_from ? 4 : 8;
    const std::uint64_t bytes = total.vertex * (3 * sizeof(Real) + (request.ends ? 16 + sizeof(Real) : 0) + (request.normals ? 12 : 0)) +
                                total.triangle * (3 * index_bytes + (request.source_cells ? 8 : 0));
    // Asking the system how much is free takes longer than extracting a small surface.
    if (bytes > std::uint64_t{1} << 26)
        if (auto ok = core::require_memory("the surface", bytes); !ok) return ok.error();
    core::Buffer<Real> positions(3 * total.vertex), weights(request.ends ? total.vertex : 0);
    core::Buffer<float> normals(request.normals ? 3 * total.vertex : 0);
    core::Buffer<std::int64_t> ends(request.ends ? 2 * total.vertex : 0), source_cells(request.source_cells ? total.triangle : 0);
    Target<Real> target{positions.data(), nullptr, nullptr, nullptr, nullptr};
    if (request.normals) target.normals = normals.data();
    if (request.ends) {
        target.ends = ends.data();
        target.weights = weights.data();
    }
    if (request.source_cells) target.source_cells = source_cells.data();

    ops::RawSurfaces out;
    ops::RawSurface& surface = out.surfaces.emplace_back();
    const auto emit_with = [&]<class Index>(core::Buffer<Index> triangles) {
        emit(packed, request, selection, masks, counted, starts, target, triangles.data(), progress);
        surface.triangles = std::move(triangles).to_array(3);
    };
    if (index_bytes == 4) emit_with(core::Buffer<std::uint32_t>(3 * total.triangle));
    else emit_with(core::Buffer<std::uint64_t>(3 * total.triangle));
    if (progress.cancelled()) return cancelled();

    surface.positions = std::move(positions).to_array(3);
    if (request.normals) surface.normals = std::move(normals).to_array(3);
    if (request.ends) {
        surface.ends = std::move(ends).to_array(2);
        surface.weights = std::move(weights).to_array();
    }
    if (request.source_cells) surface.source_cells = std::move(source_cells).to_array();
    surface.selected_clusters = selection.clusters.size();
    surface.tied_points = counted.tied_points;
    out.transient_bytes = selection.clusters.bytes() + selection.place.bytes() + masks.bytes() +
                              counted.counts.bytes() + counted.records.bytes() + counted.record_bytes + starts.bytes();
    return out;
}

} // namespace

template <class Real>
Result<ops::RawSurfaces> extract(const core::Packed& packed, const ops::Request<Real>& request, const Progress& progress) {
    ops::RawSurfaces all;
    for (const Real isovalue : request.isovalues) {
        ops::Request<Real> single = request;
        single.isovalues = {isovalue};
        auto one = extract_one(packed, single, progress);
        if (!one) return one;
        all.surfaces.push_back(std::move(one->surfaces.front()));
        all.transient_bytes = std::max(all.transient_bytes, one->transient_bytes);
    }
    return all;
}

template Result<ops::RawSurfaces> extract<float>(const core::Packed&, const ops::Request<float>&, const Progress&);
template Result<ops::RawSurfaces> extract<double>(const core::Packed&, const ops::Request<double>&, const Progress&);

} // namespace isotet::cpu
