// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "linear/by_numbers.hpp"

#include <algorithm>
#include <limits>
#include <type_traits>

#include <fmt/core.h>

#include "base/errors.hpp"
#include "base/parallel.hpp"
#include "grid/cell_faces.hpp"
#include "linear/checked_cells.hpp"

namespace isotet::linear {

namespace {

constexpr std::size_t numbers_grain = 1 << 14;

/// `faces` checked
Array faces_by_rank(const core::FaceReader& faces, std::size_t cells, const core::Buffer<std::uint64_t>& original) {
    core::Buffer<std::uint64_t> rank(original.size()), out(faces.size());
    core::parallel_each(original.size(), numbers_grain, [&](std::size_t i) { rank[original[i]] = i; });
    std::ranges::fill(out, 0); // entries of no cell
    core::parallel_each(cells, numbers_grain, [&](std::size_t cell) {
        std::uint64_t at = faces.begin(cell);
        const std::uint64_t end = faces.end(cell);
        if (at < end) out[at] = faces.at(at);
        ++at;
        while (at < end) {
            const std::uint64_t count = out[at] = faces.at(at);
            for (const std::uint64_t last = at++ + count; at <= last; ++at) out[at] = rank[faces.at(at)];
        }
    });
    return std::move(out).to_array();
}

/// Point indices of the sorted grid as the user's; those of derived points stay.
template <class Index>
Array users_indices(const Array& indices, const core::Buffer<std::uint64_t>& original) {
    const auto from = indices.as<Index>();
    core::Buffer<Index> to(from.size());
    core::parallel_each(from.size(), numbers_grain, [&](std::size_t i) {
        const auto point = static_cast<std::uint64_t>(from[i]);
        to[i] = point < original.size() ? static_cast<Index>(original[point]) : from[i];
    });
    return std::move(to).to_array();
}

Result<Array> with_numbers_above(const Array& numbers, std::uint64_t count) {
    return numbers.visit([&]<class T>(std::span<const T> users) -> Result<Array> { // integers: checked
        using Number = std::conditional_t<std::is_signed_v<T>, std::int64_t, std::uint64_t>;
        core::Buffer<Number> out(users.size() + count);
        Number next = 0;
        for (std::size_t i = 0; i < users.size(); ++i) {
            out[i] = static_cast<Number>(users[i]);
            next = std::max(next, out[i]);
        }
        if (static_cast<std::uint64_t>(std::numeric_limits<Number>::max() - next) < count)
            return invalid_data(
                fmt::format("a point has the number {}, but the {} derived points need larger ones", next, count));
        for (std::uint64_t i = 0; i < count; ++i) out[users.size() + i] = ++next;
        return std::move(out).to_array();
    });
}

} // namespace

Result<core::Renumbered> sort_by_numbers(const Grid& grid, const Progress& progress) {
    const auto all = checked_cells(grid, progress);
    if (!all) return all.error();
    auto sorted = core::sort_points_by_number(grid);
    if (!sorted) return sorted.error();
    if (all->faces.has_faces())
        sorted->grid.cells.faces = faces_by_rank(all->faces, all->cells.count(), sorted->original);
    return sorted;
}

Result<LinearGrid> in_users_order(LinearGrid&& sorted, const Grid& user, const core::Buffer<std::uint64_t>& original) {
    LinearGrid out = std::move(sorted);
    auto numbers = with_numbers_above(user.point_numbers, out.derived.count());
    if (!numbers) return numbers.error();
    const Array& connectivity = out.grid.cells.connectivity;
    out.grid.cells.connectivity = connectivity.type() == ScalarType::int32
                                      ? users_indices<std::int32_t>(connectivity, original)
                                      : users_indices<std::int64_t>(connectivity, original);
    if (out.derived.count() > 0) out.derived.points = users_indices<std::uint64_t>(out.derived.points, original);
    auto points = out.extend(user.points);
    if (!points) return points.error();
    out.grid.points = *std::move(points);
    out.grid.point_numbers = *std::move(numbers);
    return out;
}

} // namespace isotet::linear
