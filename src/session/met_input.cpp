// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <span>
#include <utility>

#include "base/buffer.hpp"
#include "base/parallel.hpp"
#include "grid/cell_faces.hpp"
#include "grid/cells.hpp"
#include "grid/points/used_points.hpp"
#include "numbers/storage.hpp"
#include "session/linear_input.hpp"

namespace isotet::session {

namespace {

/// Values that are stored without a change of scale, if others of that kind are beside them.
bool keeps_its_scale(const Array& array) {
    const auto all_plain = [](const auto& values) {
        std::atomic<bool> plain{true};
        core::parallel_ranges(values.size(), 1 << 16, [&](std::size_t begin, std::size_t end) {
            const bool odd = std::ranges::any_of(values.subspan(begin, end - begin), [](auto value) {
                using Value = decltype(value);
                const Value magnitude = std::abs(value);
                return magnitude > 0 &&
                       (magnitude < Value(1e-30) || (magnitude > Value(1e30) && !std::isinf(magnitude)));
            });
            if (odd) plain.store(false, std::memory_order_relaxed);
        });
        return plain.load();
    };
    if (array.type() == ScalarType::float32) return all_plain(array.as<float>());
    return array.type() == ScalarType::float64 && all_plain(array.as<double>());
}

/// By point: 1 where a cell that is contoured has it.
std::vector<std::uint8_t> used_points(const core::CellReader& cells, const core::FaceReader& faces) {
    return core::points_of_cells(cells, [&](std::size_t cell) {
        return core::is_polyhedron(cells, faces, cell) || core::is_contoured(cells.type(cell));
    });
}

ValueRange range_of(const PointField& field, const std::vector<std::uint8_t>& used) {
    core::ValueStatistics all;
    std::mutex mutex;
    field.values.visit([&](auto values) {
        core::parallel_ranges(used.size(), 1 << 16, [&](std::size_t begin, std::size_t end) {
            core::ValueStatistics part;
            for (std::size_t i = begin; i < end; ++i)
                if (used[i]) part.add(static_cast<double>(values[i]));
            const std::lock_guard lock(mutex);
            all.combine(part);
        });
    });
    return {all.lower, all.upper};
}

/// The lowest and the highest finite value of a component at the used points, and the first points that have them.
struct Ends {
    double lower = INFINITY, upper = -INFINITY;
    std::size_t lowest = 0, highest = 0;

    void add(double value, std::size_t point) {
        if (!std::isfinite(value)) return;
        if (value < lower || (value == lower && point < lowest)) lower = value, lowest = point;
        if (value > upper || (value == upper && point < highest)) upper = value, highest = point;
    }
    void combine(const Ends& other) {
        if (!(other.lower <= other.upper)) return;
        add(other.lower, other.lowest);
        add(other.upper, other.highest);
    }
};

/// Offset and origin of what is rounded to be stored come from the ends of its range: points that have them.
void add_ends(const Array& array, const std::vector<std::uint8_t>& used, std::vector<std::size_t>& points) {
    if (array.type() != ScalarType::float64) return;
    const std::size_t width = array.components();
    const std::span<const double> values = array.as<double>();
    for (std::size_t k = 0; k < width; ++k) {
        Ends all;
        std::mutex mutex;
        core::parallel_ranges(used.size(), 1 << 16, [&](std::size_t begin, std::size_t end) {
            Ends part;
            for (std::size_t i = begin; i < end; ++i)
                if (used[i]) part.add(values[i * width + k], i);
            const std::lock_guard lock(mutex);
            all.combine(part);
        });
        if (all.lower <= all.upper) points.insert(points.end(), {all.lowest, all.highest});
    }
}

/// Polyhedra with one of some points, which `used` marks by 2.
std::vector<std::uint64_t> cells_at(const core::CellReader& cells, const core::FaceReader& faces,
                                    const std::vector<std::uint8_t>& used) {
    std::vector<std::uint64_t> found;
    std::mutex mutex;
    core::parallel_each(cells.count(), 1 << 13, [&](std::size_t cell) {
        if (!core::is_polyhedron(cells, faces, cell)) return;
        for (std::uint64_t i = 0; i < cells.corners(cell); ++i) {
            if (used[cells.corner(cells.first(cell) + i)] != 2) continue;
            const std::lock_guard lock(mutex);
            found.push_back(cell);
            return;
        }
    });
    std::ranges::sort(found);
    return found;
}

/// Open polyhedra are left out: the points may be in no cell.
Result<bool> has_points(const Grid& grid, std::span<const std::size_t> points) {
    if (points.empty()) return true;
    const auto cells = core::CellReader::open(grid);
    if (!cells) return cells.error();
    const auto faces = core::FaceReader::open(grid.cells);
    if (!faces) return faces.error();
    const std::vector<std::uint8_t> used = used_points(*cells, *faces);
    return std::ranges::all_of(points, [&](std::size_t point) { return used[point] != 0; });
}

} // namespace

bool MetInput::suits(const ContourInput& input, const ContourOptions& options) {
    const bool gradients = options.normals == Normals::gradient;
    const Method method = method_for(options.surfaces, gradients, options.method);
    const auto plain = [](const Field& field) { return keeps_its_scale(field.values); };
    const ScalarType points = input.grid.points.type();
    return !options.expected_isovalues.empty() && options.surfaces > 0 && method == Method::direct &&
           options.engine->extracts_directly() && !options.exact_vertices && !options.frame &&
           input.grid.point_numbers.empty() && (points == ScalarType::float32 || points == ScalarType::float64) &&
           input.field.cell_values.empty() && has_cells_to_linearize(input.grid.cells) &&
           !has_curved_cells(input.grid.cells) && keeps_its_scale(input.field.values) &&
           std::ranges::all_of(input.point_fields, plain);
}

bool MetInput::is_good_for(std::span<const double> isovalues) const {
    return std::ranges::all_of(
        isovalues, [&](double isovalue) { return std::ranges::find(isovalues_, isovalue) != isovalues_.end(); });
}

Result<std::optional<ContourInput>> MetInput::make(const ContourInput& input, const ContourOptions& options,
                                                   const Run& run) {
    MetInput next;
    next.isovalues_ = options.expected_isovalues;
    // What does not fit is told by whoever takes all cells.
    const auto fits = [&](const Array& values) { return values.tuples() == input.grid.points.tuples(); };
    if (!fits(input.field.values) || input.field.values.components() != 1 ||
        !std::ranges::all_of(input.point_fields, fits, &Field::values))
        return std::optional<ContourInput>();
    const auto cells = core::CellReader::open(input.grid);
    if (!cells) return cells.error();
    const auto faces = core::FaceReader::open(input.grid.cells);
    if (!faces) return faces.error();
    std::vector<std::size_t> ends;
    std::vector<std::uint64_t> also;
    const auto rounded = [](const Array& array) { return array.type() == ScalarType::float64; };
    if (rounded(input.grid.points) || rounded(input.field.values) ||
        std::ranges::any_of(input.point_fields, rounded, &Field::values)) {
        if (auto sound = core::check_cells(input.grid, *cells, {}); !sound) return sound.error();
        std::vector<std::uint8_t> used = used_points(*cells, *faces);
        add_ends(input.grid.points, used, ends);
        add_ends(input.field.values, used, ends);
        for (const Field& field : input.point_fields) add_ends(field.values, used, ends);
        for (const std::size_t point : ends) used[point] = 2;
        also = cells_at(*cells, *faces, used);
    }
    auto linear = linearize(input.grid,
                            {.isovalues = next.isovalues_,
                             .values = input.field.values,
                             .also = std::move(also),
                             .numbers = options.edge_ends,
                             .around = options.normals == Normals::gradient},
                            run);
    if (!linear) return linear.error();
    if (linear->grid.cells.count() == 0) return std::optional<ContourInput>();
    next.range_ = range_of(input.field, used_points(*cells, *faces));
    const auto same_storage = has_points(linear->grid, ends);
    if (!same_storage) return same_storage.error();
    if (!*same_storage) return std::optional<ContourInput>();
    next.linear_ = std::make_shared<const LinearGrid>(*std::move(linear));
    next.user_ = input;
    auto made = on_linear_grid(input, *next.linear_, run);
    if (!made) return made.error();
    *this = std::move(next);
    return std::optional(*std::move(made));
}

} // namespace isotet::session
