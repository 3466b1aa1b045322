// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/files/time_values.hpp"

#include <charconv>
#include <concepts>
#include <type_traits>

#include <fmt/format.h>

namespace isotet::io {
namespace {

/// The number with the fewest digits that rounds to `time`; as from_chars() reads it, so whatever the locale.
double as_written(float time) {
    const std::string text = fmt::format("{}", time);
    double value = time;
    std::from_chars(text.data(), text.data() + text.size(), value);
    return value;
}

} // namespace

std::vector<double> time_values(const Array& times) {
    std::vector<double> values;
    times.visit([&](auto all) {
        values.reserve(all.size());
        for (const auto time : all) {
            if constexpr (std::same_as<std::remove_cv_t<decltype(time)>, float>) values.push_back(as_written(time));
            else values.push_back(static_cast<double>(time));
        }
    });
    return values;
}

} // namespace isotet::io
