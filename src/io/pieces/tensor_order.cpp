// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/pieces/tensor_order.hpp"

#include <algorithm>
#include <cstring>
#include <string_view>
#include <type_traits>
#include <utility>

#include "base/parallel.hpp"

namespace isotet::io {
namespace {

/// 0 for x, X and 1.
std::optional<std::uint8_t> axis_of(char letter) {
    for (const std::string_view axes : {"xyz", "XYZ", "123"})
        if (const auto at = axes.find(letter); at != std::string_view::npos) return static_cast<std::uint8_t>(at);
    return std::nullopt;
}

/// The place in VTK's order of a component whose name ends in two axes.
std::optional<std::size_t> place_of(std::string_view name) {
    constexpr std::size_t places[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};
    if (name.size() < 2) return std::nullopt;
    const auto row = axis_of(name[name.size() - 2]), column = axis_of(name.back());
    if (!row || !column) return std::nullopt;
    return places[*row][*column];
}

} // namespace

std::optional<TensorOrder> order_of_names(std::span<const std::string> names) {
    TensorOrder order{};
    std::array<bool, 6> known{};
    if (names.size() != order.size()) return std::nullopt;
    for (std::uint8_t i = 0; i < order.size(); ++i) {
        const auto place = place_of(names[i]);
        if (!place || std::exchange(known[*place], true)) return std::nullopt;
        order[*place] = i;
    }
    return std::ranges::is_sorted(order) ? std::nullopt : std::optional(order);
}

void order_as_vtk(std::byte* values, std::size_t tuples, std::size_t size, const TensorOrder& from) {
    constexpr std::size_t at_once = std::size_t{1} << 16, largest = 8;
    core::parallel_ranges(tuples, at_once, [&](std::size_t begin, std::size_t end) {
        std::array<std::byte, std::tuple_size_v<TensorOrder> * largest> tuple;
        for (std::size_t i = begin; i < end; ++i) {
            std::byte* const own = values + i * from.size() * size;
            std::memcpy(tuple.data(), own, from.size() * size);
            for (std::size_t k = 0; k < from.size(); ++k)
                std::memcpy(own + k * size, tuple.data() + from[k] * size, size);
        }
    });
}

Array ordered_as_vtk(const Array& values, const TensorOrder& from) {
    return values.visit([&](auto own) {
        std::vector<std::remove_const_t<typename decltype(own)::element_type>> copy(own.begin(), own.end());
        order_as_vtk(copy, from);
        return Array::own(std::move(copy), from.size());
    });
}

} // namespace isotet::io
