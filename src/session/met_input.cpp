// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <span>
#include <utility>

#include "core/buffer.hpp"
#include "core/cell_faces.hpp"
#include "core/cells.hpp"
#include "core/parallel.hpp"
#include "core/storage.hpp"
#include "session/linear_input.hpp"

namespace isotet::session {

namespace {

/// Float32 values that packing and direct extraction store as they are, if others of that kind are beside them.
bool is_stored_as_it_is(const Array& array) {
    if (array.type() != ScalarType::float32) return false;
    const std::span<const float> values = array.as<float>();
    std::atomic<bool> plain{true};
    core::parallel_ranges(values.size(), 1 << 16, [&](std::size_t begin, std::size_t end) {
        const bool odd = std::ranges::any_of(values.subspan(begin, end - begin), [](float value) {
            const float magnitude = std::abs(value);
            return magnitude > 0 && (magnitude < 1e-30F || (magnitude > 1e30F && !std::isinf(magnitude)));
        });
        if (odd) plain.store(false, std::memory_order_relaxed);
    });
    return plain;
}

/// By point: 1 where a cell that is contoured has it.
core::Buffer<std::uint8_t> used_points(const core::CellReader& cells, const core::FaceReader& faces) {
    core::Buffer<std::uint8_t> used(cells.points());
    std::ranges::fill(used, std::uint8_t{0});
    core::parallel_each(cells.count(), 1 << 13, [&](std::size_t cell) {
        const bool polyhedron = cells.type(cell) == core::polyhedron_type && faces.begin(cell) < faces.end(cell);
        if (!polyhedron && !core::is_contoured(cells.type(cell))) return;
        for (std::uint64_t i = 0; i < cells.corners(cell); ++i)
            std::atomic_ref(used[cells.corner(cells.first(cell) + i)]).store(1, std::memory_order_relaxed);
    });
    return used;
}

ValueRange range_of(const PointField& field, const core::Buffer<std::uint8_t>& used) {
    core::ValueStatistics all;
    std::mutex mutex;
    const std::span<const float> values = field.values.as<float>();
    core::parallel_ranges(used.size(), 1 << 16, [&](std::size_t begin, std::size_t end) {
        core::ValueStatistics part;
        for (std::size_t i = begin; i < end; ++i)
            if (used[i]) part.add(static_cast<double>(values[i]));
        const std::lock_guard lock(mutex);
        all.combine(part);
    });
    return {all.lower, all.upper};
}

} // namespace

bool MetInput::suits(const ContourInput& input, const ContourOptions& options) {
    const bool gradients = options.normals == Normals::gradient;
    const Method method = options.method.value_or(method_for(options.surfaces, gradients));
    const auto plain = [](const Field& field) { return is_stored_as_it_is(field.values); };
    return !options.expected_isovalues.empty() && options.surfaces > 0 && method == Method::direct &&
           options.engine->extracts_directly() && !gradients && !options.edge_ends && !options.exact_vertices &&
           !options.frame && input.grid.point_numbers.empty() && input.grid.points.type() == ScalarType::float32 &&
           input.field.cell_values.empty() && has_cells_to_linearize(input.grid.cells) &&
           !has_curved_cells(input.grid.cells) && is_stored_as_it_is(input.field.values) &&
           std::ranges::all_of(input.point_fields, plain);
}

bool MetInput::is_good_for(std::span<const double> isovalues) const {
    return std::ranges::all_of(
        isovalues, [&](double isovalue) { return std::ranges::find(isovalues_, isovalue) != isovalues_.end(); });
}

Result<std::optional<ContourInput>> MetInput::make(const ContourInput& input, const ContourOptions& options) {
    MetInput next;
    next.isovalues_ = options.expected_isovalues;
    auto linear = linearize(input.grid, {.isovalues = next.isovalues_, .values = input.field.values});
    if (!linear) return linear.error();
    if (linear->grid.cells.count() == 0) return std::optional<ContourInput>();
    const auto cells = core::CellReader::open(input.grid);
    if (!cells) return cells.error();
    const auto faces = core::FaceReader::open(input.grid.cells);
    if (!faces) return faces.error();
    next.range_ = range_of(input.field, used_points(*cells, *faces));
    next.linear_ = std::make_shared<const LinearGrid>(*std::move(linear));
    next.user_ = input;
    auto made = on_linear_grid(input, *next.linear_, {});
    if (!made) return made.error();
    *this = std::move(next);
    return std::optional(*std::move(made));
}

} // namespace isotet::session
