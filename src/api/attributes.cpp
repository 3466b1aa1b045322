// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "api/attributes.hpp"

#include <algorithm>
#include <atomic>
#include <limits>
#include <vector>

#include "base/parallel.hpp"
#include "cpu/face_normals.hpp"
#include "numbers/arithmetic.hpp"

namespace isotet::api {

namespace {

constexpr std::size_t grain = 1 << 13;

template <class Real, class Index>
core::Vector<Real> normal_of(const Real* positions, const Index* triangle) {
    const auto corner = [&](Index v) {
        return core::Vector<Real>{positions[3 * v], positions[3 * v + 1], positions[3 * v + 2]};
    };
    return core::face_normal(corner(triangle[0]), corner(triangle[1]), corner(triangle[2]));
}

template <class Work>
void with_indices(const Array& triangles, Work&& work) {
    if (triangles.type() == ScalarType::uint32) work(triangles.as<std::uint32_t>());
    else work(triangles.as<std::uint64_t>());
}

} // namespace

template <class Real>
Array interpolate_field(const Field& field, const core::Storage& storage, const ops::RawSurface& raw,
                        const core::ArraySlot& slot) {
    const std::size_t components = field.values.components(), vertices = raw.ends.tuples();
    const auto ends = raw.ends.as<std::int64_t>();
    const auto weights = raw.weights.as<Real>();
    core::SharedBuffer<Real> out = slot.make<Real>(vertices, components);
    field.values.visit([&](auto values) {
        core::parallel_each(vertices, grain, [&](std::size_t v) {
            const auto below = static_cast<std::size_t>(ends[2 * v]), above = static_cast<std::size_t>(ends[2 * v + 1]);
            for (std::size_t k = 0; k < components; ++k)
                out[v * components + k] = core::interpolate_field(
                    core::store_value<Real>(static_cast<double>(values[below * components + k]), storage),
                    core::store_value<Real>(static_cast<double>(values[above * components + k]), storage), weights[v]);
        });
    });
    return std::move(out).to_array(components);
}

Field copy_cell_field(const Field& field, const ops::RawSurface& raw, const core::ArraySlot& slot) {
    const auto cells = raw.source_cells.as<std::int64_t>();
    const std::size_t components = field.values.components();
    Field out{field.name, {}};
    field.values.visit([&]<class T>(std::span<const T> values) {
        core::SharedBuffer<T> copy = slot.make<T>(cells.size(), components);
        core::parallel_each(cells.size(), grain, [&](std::size_t t) {
            std::copy_n(values.data() + static_cast<std::size_t>(cells[t]) * components, components,
                        copy.data() + t * components);
        });
        out.values = std::move(copy).to_array(components);
    });
    return out;
}

template <class Real>
Array face_normals(const ops::RawSurface& raw, const core::ArraySlot& slot) {
    core::SharedBuffer<float> normals = slot.make<float>(raw.triangles.tuples(), 3);
    const Real* positions = raw.positions.as<Real>().data();
    with_indices(raw.triangles, [&](auto triangles) {
        core::parallel_ranges(raw.triangles.tuples(), grain, [&](std::size_t begin, std::size_t end) {
            cpu::face_normals(positions, triangles.data() + 3 * begin, end - begin, normals.data() + 3 * begin);
        });
    });
    return std::move(normals).to_array(3);
}

namespace {

/// Vertices whose normal is zero, ascending.
core::Buffer<std::uint64_t> zero_normals(std::span<const float> normals) {
    const std::size_t vertices = normals.size() / 3, tasks = (vertices + grain - 1) / grain;
    const auto for_zeros = [&](std::size_t task, auto&& f) {
        for (std::size_t v = task * grain; v < std::min(vertices, (task + 1) * grain); ++v)
            if (normals[3 * v] == 0 && normals[3 * v + 1] == 0 && normals[3 * v + 2] == 0) f(v);
    };
    std::vector<std::size_t> first(tasks + 1);
    core::parallel_each(tasks, 1, [&](std::size_t task) { for_zeros(task, [&](std::size_t) { ++first[task + 1]; }); });
    for (std::size_t task = 0; task < tasks; ++task) first[task + 1] += first[task];
    core::Buffer<std::uint64_t> zeros(first[tasks]);
    if (first[tasks] == 0) return zeros;
    core::parallel_each(tasks, 1, [&](std::size_t task) {
        std::size_t next = first[task];
        for_zeros(task, [&](std::size_t v) { zeros[next++] = v; });
    });
    return zeros;
}

} // namespace

template <class Real>
Array fill_normals(const ops::RawSurface& raw) {
    const core::Buffer<std::uint64_t> zeros = zero_normals(raw.normals.as<float>());
    if (zeros.empty()) return raw.normals;
    core::Buffer<std::uint64_t> lowest(zeros.size()); // triangle
    std::fill(lowest.begin(), lowest.end(), std::numeric_limits<std::uint64_t>::max());
    const Real* positions = raw.positions.as<Real>().data();
    // The engine has just made this array, and nothing else refers to it: it is finished in place.
    float* const normals = const_cast<float*>(raw.normals.as<float>().data());
    with_indices(raw.triangles, [&](auto triangles) {
        core::parallel_each(triangles.size(), grain, [&](std::size_t corner) {
            const std::uint64_t* const zero =
                std::lower_bound(zeros.begin(), zeros.end(), std::uint64_t{triangles[corner]});
            if (zero == zeros.end() || *zero != triangles[corner]) return;
            std::atomic_ref<std::uint64_t> slot(lowest[static_cast<std::size_t>(zero - zeros.begin())]);
            std::uint64_t seen = slot.load(std::memory_order_relaxed);
            const std::uint64_t triangle = corner / 3;
            while (triangle < seen && !slot.compare_exchange_weak(seen, triangle, std::memory_order_relaxed)) {}
        });
        core::parallel_each(zeros.size(), grain, [&](std::size_t i) {
            const auto n = normal_of(positions, triangles.data() + 3 * lowest[i]);
            for (std::size_t axis = 0; axis < 3; ++axis) normals[3 * zeros[i] + axis] = static_cast<float>(n[axis]);
        });
    });
    return raw.normals;
}

template Array interpolate_field<float>(const Field&, const core::Storage&, const ops::RawSurface&,
                                        const core::ArraySlot&);
template Array interpolate_field<double>(const Field&, const core::Storage&, const ops::RawSurface&,
                                         const core::ArraySlot&);
template Array face_normals<float>(const ops::RawSurface&, const core::ArraySlot&);
template Array face_normals<double>(const ops::RawSurface&, const core::ArraySlot&);
template Array fill_normals<float>(const ops::RawSurface&);
template Array fill_normals<double>(const ops::RawSurface&);

} // namespace isotet::api
