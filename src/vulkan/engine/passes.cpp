// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "vulkan/engine/passes.hpp"

#include <cstddef>

#include "engine_shaders.hpp"
#include "vulkan/engine/address.hpp"

namespace isotet::vulkan {

namespace {

using layout::Lists;
using layout::Output;

layout::ExtractPush push_of(const Resident& resident, const Task& task, std::uint32_t batch) {
    const core::StoredIsovalue<float>& isovalue = task.isovalue;
    return {address_of(resident.tables),
            address_of(task.surface.head),
            isovalue.value,
            isovalue.rest,
            isovalue.tied,
            task.ties == Ties::merge ? 1u : 0u,
            batch};
}

constexpr std::uint64_t arguments_in(std::size_t list) { return list + offsetof(layout::ListHead, groups_x); }

} // namespace

Result<const Kernel*> Passes::emit_kernel(Context& context, bool many_edges) const {
    const std::uint32_t constants[] = {many_edges, parts_.ends, parts_.normals == Normals::gradient, parts_.sources,
                                       resident_.sizes().with_others};
    return context.kernels().get(engine::emit, constants);
}

Result<Passes> Passes::make(Context& context, const Resident& resident, const SurfaceParts& parts) {
    Passes passes(resident, parts);
    Result<void> done;
    const auto keep = [&](const Kernel*& kernel, Result<const Kernel*> made) {
        if (made) kernel = *made;
        else if (done) done = std::move(made).error();
    };
    keep(passes.select_, context.kernels().get(engine::select));
    const std::uint32_t count_constants[] = {resident.sizes().with_others};
    keep(passes.count_, context.kernels().get(engine::count, count_constants));
    keep(passes.scan_, context.kernels().get(engine::scan));
    keep(passes.emit_few_, passes.emit_kernel(context, false));
    if (parts.normals == Normals::face) keep(passes.face_normals_, context.kernels().get(engine::face_normals));
    if (parts.normals == Normals::gradient) {
        keep(passes.lowest_triangles_, context.kernels().get(engine::lowest_triangles));
        keep(passes.missing_normals_, context.kernels().get(engine::missing_normals));
    }
    if (!parts.fields.empty()) keep(passes.fields_, context.kernels().get(engine::fields));
    if (!done) return done.error();
    return passes;
}

Result<void> Passes::make_emit_many(Context& context) {
    auto kernel = emit_kernel(context, true);
    if (!kernel) return std::move(kernel).error();
    emit_many_ = *kernel;
    return {};
}

void Passes::begin(Recorder& recorder, const Task& task) const {
    const Output head = task.surface.empty_head();
    recorder.write(task.surface.head, 0, std::as_bytes(std::span(&head, 1)));
    recorder.fill(resident_.lists, 0, sizeof(Lists), 0);
}

void Passes::begin_again(Recorder& recorder, const Task& task) const {
    const Output head = task.surface.empty_head();
    constexpr std::size_t fixed = offsetof(Output, vertex_capacity);
    recorder.write(task.surface.head, fixed, std::as_bytes(std::span(&head, 1)).subspan(fixed));
    recorder.fill(resident_.lists, offsetof(Lists, few_edges), sizeof(Lists) - offsetof(Lists, few_edges), 0);
}

void Passes::select(Recorder& recorder, const Task& task) const {
    const Resident& r = resident_;
    recorder.dispatch(*select_, push_of(r, task, 0), r.sizes().segments,
                      {reads(r.tables), reads(r.clusters), reads(r.ranges), writes(r.masks), writes(r.counts),
                       writes(r.sums), writes(r.selected), writes(r.lists), writes(task.surface.head)});
}

void Passes::count(Recorder& recorder, const Task& task, std::uint32_t batch) const {
    const Resident& r = resident_;
    recorder.dispatch_indirect(*count_, push_of(r, task, batch), r.lists, arguments_in(offsetof(Lists, selected)),
                               {reads(r.tables), reads(r.pages), reads(r.clusters), reads(r.ranges), reads(r.no_data),
                                reads(r.cell_cases), reads(r.selected), reads(r.lists), writes(r.masks),
                                writes(r.counts), writes(r.sums), writes(task.surface.head)});
}

void Passes::scan(Recorder& recorder, const Task& task) const {
    const Resident& r = resident_;
    recorder.dispatch(*scan_, push_of(r, task, 0), r.sizes().segments,
                      {reads(r.tables), reads(r.counts), reads(r.sums), writes(r.starts), writes(r.emitted),
                       writes(r.lists), writes(task.surface.head)});
}

void Passes::emit(Recorder& recorder, const Task& task, std::uint32_t batch) const {
    const Resident& r = resident_;
    const SurfaceBuffers& s = task.surface;
    std::vector<Use> uses{reads(r.tables), reads(r.pages),  reads(r.cell_cases), reads(r.clusters), reads(r.ranges),
                          reads(r.masks),  reads(r.starts), reads(r.emitted),    reads(r.lists),    writes(s.head)};
    for (const Buffer* array : {&s.positions, &s.triangles, &s.normals, &s.lowest, &s.ends, &s.weights, &s.sources})
        if (*array) uses.push_back(writes(*array));
    const layout::ExtractPush push = push_of(r, task, batch);
    recorder.dispatch_indirect(*emit_few_, push, r.lists, arguments_in(offsetof(Lists, few_edges)), uses);
    if (!emit_many_) return;
    recorder.label("emit, many edges");
    recorder.dispatch_indirect(*emit_many_, push, r.lists, arguments_in(offsetof(Lists, many_edges)), uses);
    recorder.label("");
}

void Passes::normals(Recorder& recorder, const Task& task) const {
    const SurfaceBuffers& s = task.surface;
    if (!s.normals) return;
    const layout::SurfacePush push{address_of(s.head)};
    const std::uint64_t of_vertices = offsetof(Output, vertex_groups_x),
                        of_triangles = offsetof(Output, triangle_groups_x);
    if (face_normals_)
        recorder.dispatch_indirect(*face_normals_, push, s.head, of_triangles,
                                   {reads(s.head), reads(s.positions), reads(s.triangles), writes(s.normals)});
    if (!missing_normals_) return;
    recorder.dispatch_indirect(*lowest_triangles_, push, s.head, of_triangles,
                               {reads(s.head), reads(s.triangles), reads(s.normals), writes(s.lowest)});
    recorder.dispatch_indirect(
        *missing_normals_, push, s.head, of_vertices,
        {reads(s.head), reads(s.positions), reads(s.triangles), reads(s.lowest), writes(s.normals)});
}

void Passes::fields(Recorder& recorder, const Task& task) const {
    const SurfaceBuffers& s = task.surface;
    for (std::size_t i = 0; i < s.fields.size() && s.fields[i]; ++i) {
        const CarriedField& from = *task.fields[i];
        const layout::FieldPush push{address_of(s.head), address_of(from.values), address_of(s.fields[i]),
                                     from.components};
        recorder.dispatch_indirect(
            *fields_, push, s.head, offsetof(Output, vertex_groups_x),
            {reads(s.head), reads(s.ends), reads(s.weights), reads(from.values), writes(s.fields[i])});
    }
}

void Passes::finish(Recorder& recorder, const Task& task) const {
    normals(recorder, task);
    fields(recorder, task);
}

Result<void> Passes::ranges(Context& context, Recorder& recorder, const Resident& r) {
    auto kernel = context.kernels().get(engine::ranges);
    if (!kernel) return kernel.error();
    recorder.dispatch(**kernel, layout::RangesPush{address_of(r.tables)}, r.sizes().clusters,
                      {reads(r.tables), reads(r.pages), reads(r.clusters), writes(r.ranges), writes(r.no_data)});
    return {};
}

} // namespace isotet::vulkan
