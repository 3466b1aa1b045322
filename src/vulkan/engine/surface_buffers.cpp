// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "vulkan/engine/surface_buffers.hpp"

#include <algorithm>
#include <limits>

#include "base/system/memory.hpp"
#include "base/parallel.hpp"

namespace isotet::vulkan {

namespace {

constexpr std::uint64_t vector_bytes = 12, word_bytes = 4;
constexpr std::size_t numbers_per_task = 1 << 15;

template <class T>
Result<core::Buffer<T>> download_array(Context& context, const Buffer& from, std::uint64_t count) {
    core::Buffer<T> out(count);
    if (count > 0)
        if (auto ok = context.staging().download(from, 0, std::as_writable_bytes(std::span(out.data(), count))); !ok)
            return ok.error();
    return out;
}

/// Downloads numbers and replaces each by the user's.
template <class Number>
Result<void> fetch_numbers(Context& context, Array& to, const Buffer& from, std::uint64_t tuples,
                           std::size_t components, const Number& number) {
    auto packed = download_array<std::uint32_t>(context, from, tuples * components);
    if (!packed) return packed.error();
    core::Buffer<std::int64_t> out(packed->size());
    core::parallel_each(out.size(), numbers_per_task,
                        [&](std::size_t i) { out[i] = static_cast<std::int64_t>(number((*packed)[i])); });
    to = std::move(out).to_array(components);
    return {};
}

std::uint32_t with_spare(std::uint64_t items) {
    constexpr std::uint64_t most = std::numeric_limits<std::uint32_t>::max();
    return static_cast<std::uint32_t>(std::min(items + items / 4, most));
}

} // namespace

std::vector<SurfaceBuffers::Part> SurfaceBuffers::arrays() {
    const bool gradient = parts_.normals == Normals::gradient, face = parts_.normals == Normals::face;
    std::vector<Part> all{{positions, "positions", vector_bytes, 0, true},
                          {triangles, "triangles", 0, vector_bytes, true},
                          {normals, "normals", gradient ? vector_bytes : 0, face ? vector_bytes : 0, gradient || face},
                          {lowest, "lowest triangles", word_bytes, 0, gradient},
                          {ends, "edge ends", 2 * word_bytes, 0, parts_.ends},
                          {weights, "edge weights", word_bytes, 0, parts_.ends},
                          {sources, "source cells", 0, word_bytes, parts_.sources}};
    fields.resize(parts_.fields.size());
    for (std::size_t i = 0; i < fields.size(); ++i)
        all.push_back({fields[i], "field", word_bytes * parts_.fields[i], 0, true});
    return all;
}

std::uint64_t SurfaceBuffers::bytes() const {
    std::uint64_t bytes = 0;
    for (const Buffer* buffer : {&head, &positions, &triangles, &normals, &lowest, &ends, &weights, &sources})
        bytes += buffer->size();
    for (const Buffer& field : fields) bytes += field.size();
    return bytes;
}

layout::Output SurfaceBuffers::empty_head() const {
    layout::Output out{};
    out.vertex_capacity = vertex_capacity_;
    out.triangle_capacity = triangle_capacity_;
    out.positions = address_of(positions);
    out.triangles = address_of(triangles);
    out.normals = address_of(normals);
    out.lowest = address_of(lowest);
    out.ends = address_of(ends);
    out.weights = address_of(weights);
    out.sources = address_of(sources);
    return out;
}

void SurfaceBuffers::drop_arrays() {
    for (const Part& part : arrays()) part.buffer = {};
    vertex_capacity_ = triangle_capacity_ = 0;
}

Result<void> SurfaceBuffers::prepare(Context& context, const SurfaceParts& parts) {
    if (!head) {
        auto taken = context.memory().take(sizeof(layout::Output), Where::device, "head of a surface");
        if (!taken) return std::move(taken).error();
        head = *std::move(taken);
    }
    result = {};
    if (parts == parts_) return {};
    drop_arrays();
    parts_ = parts;
    return {};
}

Result<void> SurfaceBuffers::grow(Context& context, std::uint64_t vertices, std::uint64_t triangle_count, Room room) {
    const std::uint32_t v = room == Room::spare ? with_spare(vertices) : static_cast<std::uint32_t>(vertices);
    const std::uint32_t t =
        room == Room::spare ? with_spare(triangle_count) : static_cast<std::uint32_t>(triangle_count);
    drop_arrays();
    for (const Part& part : arrays()) {
        if (!part.wanted) continue;
        auto taken = context.memory().take(part.vertex_bytes * v + part.triangle_bytes * t, Where::device, part.name);
        if (!taken) {
            drop_arrays();
            return std::move(taken).error();
        }
        part.buffer = *std::move(taken);
    }
    vertex_capacity_ = v;
    triangle_capacity_ = t;
    return {};
}

Result<ops::RawSurface> SurfaceBuffers::download(Context& context, const core::Packed& packed, bool with_ends) const {
    const std::uint64_t v = vertex_count(), t = triangle_count();
    ops::RawSurface out;
    out.selected_clusters = result.selected_clusters;
    out.tied_points = result.tied_points;
    const auto fetch = [&]<class T>(Array& to, const Buffer& from, std::uint64_t tuples, std::size_t components,
                                    T) -> Result<void> {
        auto array = download_array<T>(context, from, tuples * components);
        if (!array) return array.error();
        to = std::move(*array).to_array(components);
        return {};
    };
    const auto user_point = [&](std::uint32_t point) { return packed.user_point(point); };
    const auto user_cell = [&](std::uint32_t tet) { return packed.user_cell(tet); };
    Result<void> ok = fetch(out.positions, positions, v, 3, float{});
    if (ok) ok = fetch(out.triangles, triangles, t, 3, std::uint32_t{});
    if (ok && parts_.normals != Normals::none)
        ok = fetch(out.normals, normals, parts_.normals == Normals::face ? t : v, 3, float{});
    if (ok && with_ends) ok = fetch(out.weights, weights, v, 1, float{});
    if (ok && with_ends) ok = fetch_numbers(context, out.ends, ends, v, 2, user_point);
    if (ok && parts_.sources) ok = fetch_numbers(context, out.source_cells, sources, t, 1, user_cell);
    for (std::size_t i = 0; ok && i < fields.size(); ++i)
        ok = fetch(out.fields.emplace_back(), fields[i], v, parts_.fields[i], float{});
    if (!ok) return ok.error();
    return out;
}

} // namespace isotet::vulkan
