// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "grid/values/values_in_ranges.hpp"

#include <limits>
#include <type_traits>
#include <utility>

namespace isotet::core {

std::vector<bool> restrict_to_ranges(const Array& values, std::span<const std::array<double, 2>> ranges, bool others,
                                     std::span<const std::uint8_t> skipped, std::span<std::uint8_t> chosen) {
    std::vector<std::array<double, 2>> wanted(ranges.begin(), ranges.end());
    if (values.type() == ScalarType::float32)
        for (auto& [lower, upper] : wanted)
            if (lower == upper) lower = upper = static_cast<double>(static_cast<float>(lower));
    std::vector<bool> is_there(wanted.size(), false);
    values.visit([&](auto numbers) {
        for (std::size_t cell = 0; cell < chosen.size(); ++cell) {
            if (!skipped.empty() && skipped[cell] != 0) continue;
            const auto value = static_cast<double>(numbers[cell]);
            bool inside = false;
            for (std::size_t i = 0; i < wanted.size(); ++i) {
                if (!(value >= wanted[i][0] && value <= wanted[i][1])) continue;
                inside = true;
                is_there[i] = true;
            }
            if (inside == others) chosen[cell] = 0;
        }
    });
    return is_there;
}

Array without_unused(const Array& values, std::span<const std::uint8_t> used) {
    const std::size_t width = values.components();
    return values.visit([&]<class Value>(std::span<const Value> from) {
        if constexpr (std::is_floating_point_v<Value>) {
            std::vector<Value> to(from.begin(), from.end());
            for (std::size_t i = 0; i < to.size(); ++i)
                if (i / width < used.size() && !used[i / width]) to[i] = std::numeric_limits<Value>::quiet_NaN();
            return Array::own(std::move(to), width);
        } else {
            return values;
        }
    });
}

} // namespace isotet::core
