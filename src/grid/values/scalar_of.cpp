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
    Scalar scalar;
    const char* end = text.data() + text.size();
    const auto [stopped, fault] = std::from_chars(text.data(), end, scalar.component);
    return fault == std::errc{} && stopped == end ? std::optional(scalar) : std::nullopt;
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
