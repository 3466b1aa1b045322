// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "grid/renumber.hpp"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "base/errors.hpp"
#include "base/parallel.hpp"
#include "base/radix_sort.hpp"
#include "grid/cells.hpp"

namespace isotet::core {

namespace {

constexpr std::size_t renumber_grain = 1 << 16;

/// Point indices by ascending number, equal ones by index.
Buffer<std::uint64_t> order_of(const Array& numbers) {
    Buffer<Keyed> sorted(numbers.tuples()), scratch(numbers.tuples());
    numbers.visit([&]<class T>(std::span<const T> typed) {
        if constexpr (std::is_integral_v<T>)
            parallel_ranges(typed.size(), renumber_grain, [&](std::size_t begin, std::size_t end) {
                constexpr std::uint64_t flip = std::is_signed_v<T> ? std::uint64_t{1} << 63 : 0; // negative ones first
                for (std::size_t i = begin; i < end; ++i) sorted[i] = {widened(typed[i]) ^ flip, i};
            });
    });
    radix_sort({sorted.data(), sorted.size()}, {scratch.data(), scratch.size()});
    Buffer<std::uint64_t> order(sorted.size());
    parallel_ranges(order.size(), renumber_grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) order[i] = sorted[i].number;
    });
    return order;
}

/// Corners of cells that are not contoured may be no points: they stay unread.
template <class Index>
Array renumbered(const IndexColumn& connectivity, std::size_t size, const Buffer<std::uint64_t>& order) {
    Buffer<Index> rank(order.size()), out(size);
    parallel_ranges(order.size(), renumber_grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) rank[order[i]] = static_cast<Index>(i);
    });
    connectivity.visit([&](const auto* corners) {
        parallel_ranges(size, renumber_grain, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                const std::uint64_t point = widened(corners[i]);
                out[i] = point < rank.size() ? rank[point] : Index(0);
            }
        });
    });
    return std::move(out).to_array();
}

} // namespace

Array in_order(const Array& values, std::span<const std::uint64_t> original) {
    const std::size_t components = values.components();
    return values.visit([&]<class T>(std::span<const T> typed) {
        Buffer<T> out(original.size() * components);
        parallel_ranges(original.size(), renumber_grain, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                std::copy_n(typed.data() + original[i] * components, components, out.data() + i * components);
        });
        return std::move(out).to_array(components);
    });
}

Array source_cells_by(const Array& cells, const Array& numbers) {
    if (cells.empty() || numbers.empty()) return cells;
    const auto number_of = numbers.as<std::uint64_t>();
    Buffer<std::int64_t> out(cells.tuples());
    cells.visit([&](auto before) {
        parallel_each(before.size(), renumber_grain, [&](std::size_t i) {
            const auto cell = static_cast<std::int64_t>(before[i]);
            out[i] = cell < 0 ? cell : static_cast<std::int64_t>(number_of[static_cast<std::size_t>(cell)]);
        });
    });
    return std::move(out).to_array();
}

Result<void> check_point_numbers(const Grid& grid) {
    const Array& numbers = grid.point_numbers;
    if (is_floating(numbers.type()) || size_of(numbers.type()) < 4 || numbers.components() != 1 ||
        numbers.tuples() != grid.points.tuples())
        return invalid_data(fmt::format("the point numbers are {} x {} {}, but must be {} 32- or 64-bit integers",
                                        numbers.tuples(), numbers.components(), name_of(numbers.type()),
                                        grid.points.tuples()));
    return {};
}

Result<Renumbered> sort_points_by_number(const Grid& grid) {
    if (auto ok = check_point_numbers(grid); !ok) return ok.error();
    const Array& numbers = grid.point_numbers;
    Renumbered out;
    out.original = order_of(numbers);
    const IndexColumn connectivity(grid.cells.connectivity);
    const std::size_t size = grid.cells.connectivity.tuples();
    out.grid.points = in_order(grid.points, out.original);
    out.grid.cells = grid.cells;
    out.grid.cells.connectivity = out.original.size() <= std::numeric_limits<std::uint32_t>::max()
                                      ? renumbered<std::uint32_t>(connectivity, size, out.original)
                                      : renumbered<std::uint64_t>(connectivity, size, out.original);
    return out;
}

} // namespace isotet::core
