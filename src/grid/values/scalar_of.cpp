// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "grid/values/scalar_of.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <type_traits>

#include "base/buffer.hpp"
#include "base/parallel.hpp"

namespace isotet::core {

namespace {

constexpr std::size_t tuples_per_task = 1 << 14;

template <class Result, class At>
Array fill(std::size_t count, const At& at) {
    Buffer<Result> values(count);
    parallel_each(count, tuples_per_task, [&](std::size_t tuple) { values[tuple] = static_cast<Result>(at(tuple)); });
    return std::move(values).to_array();
}

std::optional<std::size_t> number_of(std::string_view text) {
    std::size_t number = 0;
    const char* end = text.data() + text.size();
    const auto [stopped, fault] = std::from_chars(text.data(), end, number);
    return fault == std::errc{} && stopped == end ? std::optional(number) : std::nullopt;
}

/// 0 for X and 1.
std::optional<std::size_t> axis_of(char letter) {
    if (letter >= 'X' && letter <= 'Z') return static_cast<std::size_t>(letter - 'X');
    if (letter >= '1' && letter <= '3') return static_cast<std::size_t>(letter - '1');
    return std::nullopt;
}

/// "DX", "FLUX", "D1", "SXX", "SIXX", "S11"; "V11" is an eleventh variable, "MAX" is none.
std::optional<Scalar> called_by_solvers(std::string_view text) {
    constexpr std::size_t most = 3;
    if (text.size() < 2 || text == "MAX") return std::nullopt;
    const auto are_capitals = [](std::string_view word) {
        return !word.empty() && word.size() <= most &&
               std::ranges::all_of(word, [](char c) { return c >= 'A' && c <= 'Z'; });
    };
    const char last = text.back(), before = text[text.size() - 2];
    const auto row = axis_of(before), column = axis_of(last);
    const bool is_pair = row && column && (last >= 'X' ? before >= 'X' : before <= '3' && text[0] != 'V');
    if (is_pair && text.size() <= 4 && are_capitals(text.substr(0, text.size() - 2)))
        return Scalar{3 * *row + *column, false, true};
    if (last >= 'X' && column && are_capitals(text.substr(0, text.size() - 1))) return Scalar{*column};
    const auto number = are_capitals(text.substr(0, 1)) ? number_of(text.substr(1)) : std::nullopt;
    return number && *number > 0 ? std::optional(Scalar{*number - 1}) : std::nullopt;
}

} // namespace

std::optional<std::size_t> Scalar::place_in(std::size_t components) const {
    constexpr std::size_t symmetric[] = {0, 3, 5, 3, 1, 4, 5, 4, 2};
    if (magnitude) return 0;
    if (of_tensor && components == 6) return symmetric[component];
    return component < components && (!of_tensor || components == 9) ? std::optional(component) : std::nullopt;
}

std::optional<Scalar> parse_scalar(std::string_view text) {
    if (text == "mag") return Scalar{0, true};
    if (text == "x" || text == "y" || text == "z") return Scalar{static_cast<std::size_t>(text[0] - 'x'), false};
    for (const char first : {'x', 'X'})
        if (text.size() == 2 && std::ranges::all_of(text, [&](char c) { return c >= first && c <= first + 2; }))
            return Scalar{static_cast<std::size_t>(3 * (text[0] - first) + text[1] - first), false, true};
    const auto number = number_of(text);
    return number ? std::optional(Scalar{*number}) : called_by_solvers(text);
}

double scalar_at(const Array& array, Scalar scalar, std::size_t tuple) {
    const std::size_t components = array.components();
    return array.visit([&](auto values) {
        if (scalar.magnitude) return magnitude_of(values.data() + tuple * components, components);
        return static_cast<double>(values[tuple * components + scalar.component]);
    });
}

Array scalar_of(const Array& array, Scalar scalar) {
    const std::size_t components = array.components();
    if (components == 1 && !scalar.magnitude) return array;
    return array.visit([&](auto values) {
        using Value = std::remove_const_t<typename decltype(values)::element_type>;
        if (!scalar.magnitude)
            return fill<Value>(array.tuples(),
                               [&](std::size_t tuple) { return values[tuple * components + scalar.component]; });
        using Magnitude = std::conditional_t<std::is_same_v<Value, float>, float, double>;
        return fill<Magnitude>(
            array.tuples(), [&](std::size_t tuple) { return magnitude_of(&values[tuple * components], components); });
    });
}

} // namespace isotet::core
