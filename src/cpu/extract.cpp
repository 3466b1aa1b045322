// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "cpu/extract.hpp"

#include <algorithm>
#include <numeric>
#include <string_view>

#include "base/system/memory.hpp"
#include "base/parallel.hpp"
#include "cpu/batches.hpp"
#include "cpu/steps.hpp"
#include "cpu/surface_arrays.hpp"

namespace isotet::cpu {

namespace {

/// Memory that an extraction needs, surfaces included, told before it is taken.
template <class Real>
class Need {
public:
    Need(const ops::Request<Real>& request, const Selection& selection, const Masks& masks)
        : request_(request), threads_(static_cast<std::size_t>(core::threads_here())) {
        const std::size_t places = selection.size();
        fixed_ = selection.bytes() + masks.bytes() + places * (sizeof(Start) + sizeof(void*)) +
                 threads_ * (count_scratch_bytes<Real>() + emit_scratch_bytes<Real>());
        Total most;
        most.vertices = 4 * selection.tets;
        most.triangles = 2 * selection.tets;
        const std::size_t records = places * sizeof(Record<Real>) +
                                    Record<Real>::bytes(most.vertices, most.vertices, most.triangles, true, true);
        at_most_ = of({most}, records);
    }

    std::uint64_t at_most() const { return at_most_; }

    std::uint64_t of(const std::vector<Total>& totals, std::size_t record_bytes) const {
        std::uint64_t bytes = fixed_ + Arena::max_bytes(record_bytes, threads_);
        for (const Total& total : totals)
            bytes += SurfaceArrays<Real>::bytes(request_, total) + total.vertices * request_.more_vertex_bytes +
                     total.triangles * request_.more_triangle_bytes;
        return bytes;
    }

private:
    const ops::Request<Real>& request_;
    std::size_t threads_;
    std::uint64_t fixed_ = 0, at_most_ = 0;
};

/// The grid, and those of fields that are carried.
template <class Real>
std::vector<const core::Packed*> grids_of(const core::Packed& packed, const ops::Request<Real>& request) {
    std::vector<const core::Packed*> grids{&packed};
    for (const ops::CarriedField& field : request.fields)
        if (field.packed) grids.push_back(field.packed.get());
    return grids;
}

/// What is needed is known exactly only once everything has been counted. But a bound is known from the selected
/// clusters, and mostly there is far more memory. Asking the system how much takes longer than extracting a small
/// surface.
constexpr std::uint64_t ask_from = std::uint64_t{256} << 20;

} // namespace

template <class Real>
Result<ops::RawSurfaces> extract(const core::Packed& packed, const ops::Request<Real>& request,
                                 const Progress& progress) {
    const auto cancelled = [] { return Error{ErrorCode::cancelled, "extraction was cancelled"}; };
    ops::RawSurfaces out;
    if (request.isovalues.empty()) return out;

    std::vector<std::size_t> order(request.isovalues.size()); // ascending isovalue -> the caller's
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::sort(order, {}, [&](std::size_t i) { return request.isovalues[i].value; });
    std::vector<core::StoredIsovalue<Real>> isovalues;
    for (const std::size_t i : order) isovalues.push_back(request.isovalues[i]);
    // Where only positions are wanted, they are kept at once: more memory than ends and weights, but nothing is found
    // twice. In double precision that would be too much.
    const bool ends = sizeof(Real) > sizeof(float) || request.ends || request.normals || !request.fields.empty();
    const Wanted<Real> wanted{isovalues, request.ties, ends, request.source_cells, request.fields};

    auto selected = select(packed, wanted.isovalues);
    if (!selected) return selected.error();
    Selection& selection = *selected;
    Masks masks(selection);
    Batches batches(grids_of(packed, request), selection, progress);

    const Need<Real> need(request, selection, masks);
    out.predicted_bytes = need.at_most();
    constexpr std::string_view what = "extraction";
    if (need.at_most() > ask_from && !core::require_memory(what, need.at_most())) {
        Result<Counted<Real>> trial = count(packed, wanted, selection, masks, Keep::nothing, batches, progress);
        if (!trial) return trial.error();
        if (progress.cancelled()) return cancelled();
        out.predicted_bytes = need.of(scan(selection, masks, isovalues.size(), trial->starts), trial->record_bytes);
        if (auto ok = core::require_memory(what, out.predicted_bytes); !ok) return ok.error();
    }

    Result<Counted<Real>> all_counted = count(packed, wanted, selection, masks, Keep::records, batches, progress);
    if (!all_counted) return all_counted.error();
    Counted<Real>& counted = *all_counted;
    if (progress.cancelled()) return cancelled();
    const std::vector<Total> totals = scan(selection, masks, isovalues.size(), counted.starts);
    std::vector<SurfaceArrays<Real>> arrays;
    std::vector<Target<Real>> targets;
    arrays.reserve(totals.size());
    for (std::size_t k = 0; k < totals.size(); ++k)
        targets.push_back(arrays.emplace_back(request, order[k], totals[k]).target(request));
    const std::span<const Target<Real>> all_targets(targets);
    if (auto ok = emit(packed, wanted, selection, masks, counted, all_targets, batches, progress); !ok)
        return ok.error();
    if (progress.cancelled()) return cancelled();

    out.surfaces.resize(order.size());
    for (std::size_t k = 0; k < order.size(); ++k) {
        out.surfaces[order[k]] = std::move(arrays[k]).to_surface(request);
        out.surfaces[order[k]].tied_points = counted.tied_points[k];
    }
    out.transient_bytes = selection.bytes() + masks.bytes() + counted.bytes +
                          static_cast<std::size_t>(core::threads_here()) * emit_scratch_bytes<Real>();
    return out;
}

template Result<ops::RawSurfaces> extract<float>(const core::Packed&, const ops::Request<float>&, const Progress&);
template Result<ops::RawSurfaces> extract<double>(const core::Packed&, const ops::Request<double>&, const Progress&);

} // namespace isotet::cpu
