// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <optional>

#include <isotet/engine.hpp>
#include <isotet/extract.hpp>

#include "api/carried.hpp"
#include "api/engines.hpp"
#include "api/finish.hpp"
#include "api/fits.hpp"
#include "api/ties.hpp"
#include "base/array_slot.hpp"
#include "base/carry_out.hpp"
#include "base/parallel.hpp"
#include "cpu/extract.hpp"
#include "numbers/storage.hpp"
#include "packed/field_storage.hpp"
#include "packed/packed.hpp"
#include "packed/residency.hpp"
#include "reference/extract.hpp"

namespace isotet {

namespace {

using api::Kernels;

template <class Real, Kernels kernels>
Result<std::vector<Extraction>> extract_as(const core::Packed& packed, std::span<const double> isovalues,
                                           const ExtractOptions& options, const Progress& progress) {
    constexpr bool reference = kernels == Kernels::reference;
    ops::Request<Real> request;
    for (const double isovalue : isovalues)
        request.isovalues.push_back(core::store_isovalue<Real>(isovalue, packed.storage));
    request.ties = options.ties;
    std::vector<core::Storage> storages;
    for (const Field& field : options.point_fields) storages.push_back(core::choose_storage(field, packed));
    if (!reference)
        for (std::size_t i = 0; i < storages.size(); ++i)
            request.fields.push_back({options.point_fields[i].values, storages[i]});
    for (const PackedGrid& grid : options.packed_fields) {
        storages.push_back(grid.data().storage);
        request.fields.push_back(ops::carried_field<Real>(grid.shared_data()));
    }
    request.ends = options.edge_ends || (reference && !options.point_fields.empty());
    request.normals = options.normals == Normals::gradient;
    request.source_cells = options.source_cells || !options.cell_fields.empty();
    const api::Placement placement{packed.origin, packed.point_type};
    const api::MoreBytes more = api::more_bytes(options, placement);
    request.more_vertex_bytes = more.vertex;
    request.more_triangle_bytes = more.triangle;

    std::optional<core::RememberingSink> sink;
    if (options.sink) sink.emplace(options.sink);
    const core::ArraySlots slots = api::slots_of(options, sink ? &*sink : nullptr);
    request.slots = api::slots_for_engine<Real>(slots, placement, options, storages);
    auto raw =
        reference ? isotet::reference::extract(packed, request, progress) : cpu::extract(packed, request, progress);
    if (!raw) return std::move(raw).error();
    progress("extract", 0.8);

    std::uint64_t transient = raw->transient_bytes;
    std::vector<Extraction> out(isovalues.size());
    for (std::size_t i = 0; i < out.size(); ++i) {
        ops::RawSurface& surface = raw->surfaces[i];
        ExtractReport& report = out[i].report;
        out[i].surface = api::finish<Real>(placement, options, storages, surface, slots, i);
        if (sink) sink->bring(out[i].surface, i);
        const auto told =
            api::report_ties(packed, isovalues[i], request.isovalues[i], surface.tied_points, report, progress);
        if (!told) return told.error();
        report.selected_clusters = surface.selected_clusters;
        report.surface_bytes = api::bytes_of(out[i].surface);
        report.predicted_bytes = raw->predicted_bytes;
        if (!options.edge_ends) transient += surface.ends.bytes() + surface.weights.bytes();
        if (!options.source_cells) transient += surface.source_cells.bytes();
        surface = {}; // parts that only attributes needed go as soon as they can
    }
    for (Extraction& extraction : out) extraction.report.transient_bytes = transient;
    progress("extract", 1);
    return out;
}

} // namespace

template <Kernels kernels>
Result<std::vector<Extraction>> api::extract_by(const PackedGrid& packed, std::span<const double> isovalues,
                                                const ExtractOptions& options, const Run& run) {
    return core::carry_out("extraction", run, [&](const Progress& progress) -> Result<std::vector<Extraction>> {
        if (auto ok = api::check_isovalues(isovalues); !ok) return ok.error();
        if (auto ok = api::check_fit(options, packed.data()); !ok) return ok.error();
        std::shared_ptr<const core::Packed> data = packed.shared_data();
        ExtractOptions all = options;
        // How fields of the user are stored depends on their values at all points of the packed grid.
        if (kernels == Kernels::reference || (data->residency && !options.point_fields.empty())) {
            const auto whole = core::whole_of(data, progress);
            if (!whole) return whole.error();
            data = *whole;
            auto unpacked = api::with_unpacked_fields(std::move(all), {.progress = progress});
            if (!unpacked) return unpacked.error();
            all = *std::move(unpacked);
        }
        return data->single() ? extract_as<float, kernels>(*data, isovalues, all, progress)
                              : extract_as<double, kernels>(*data, isovalues, all, progress);
    });
}

template Result<std::vector<Extraction>> api::extract_by<Kernels::cpu>(const PackedGrid&, std::span<const double>,
                                                                       const ExtractOptions&, const Run&);
template Result<std::vector<Extraction>> api::extract_by<Kernels::reference>(const PackedGrid&, std::span<const double>,
                                                                             const ExtractOptions&, const Run&);

Result<std::vector<Extraction>> extract(const PackedGrid& packed, std::span<const double> isovalues,
                                        const ExtractOptions& options, const Run& run) {
    return api::extract_by<Kernels::cpu>(packed, isovalues, options, run);
}

Result<Extraction> extract(const PackedGrid& packed, double isovalue, const ExtractOptions& options, const Run& run) {
    auto all = extract(packed, std::span(&isovalue, 1), options, run);
    if (!all) return std::move(all).error();
    return std::move(all->front());
}

Result<std::vector<Extraction>> extract_by_reference(const PackedGrid& packed, std::span<const double> isovalues,
                                                     const ExtractOptions& options, const Run& run) {
    return api::extract_by<Kernels::reference>(packed, isovalues, options, run);
}

} // namespace isotet
