// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/pieces/number_map.hpp"

#include <algorithm>
#include <utility>

#include <fmt/core.h>

namespace isotet::io {

void NumberMap::spread() {
    consecutive_ = false;
    numbers_.reserve(count_ + 1);
    for (std::uint64_t i = 0; i < count_; ++i) {
        numbers_.push_back(static_cast<std::int64_t>(static_cast<std::uint64_t>(first_) + i));
    }
}

Result<void> NumberMap::close(std::string_view what) {
    if (consecutive_) return {};
    const auto twice = [&](std::int64_t number) {
        return Error{ErrorCode::invalid_data,
                     fmt::format("{} {} occurs twice, but numbers must be unique", what, number)};
    };
    const std::vector<std::int64_t> numbers = std::exchange(numbers_, {});
    const auto [lowest, highest] = std::minmax_element(numbers.begin(), numbers.end());
    const std::uint64_t range = static_cast<std::uint64_t>(*highest) - static_cast<std::uint64_t>(*lowest);
    if (range / 4 <= count_ && count_ < empty) {
        first_ = *lowest;
        table_.assign(range + 1, empty);
        for (std::size_t i = 0; i < numbers.size(); ++i) {
            std::uint32_t& place = table_[static_cast<std::uint64_t>(numbers[i]) - static_cast<std::uint64_t>(first_)];
            if (place != empty) return twice(numbers[i]);
            place = static_cast<std::uint32_t>(i);
        }
        return {};
    }
    sorted_.reserve(numbers.size());
    for (std::size_t i = 0; i < numbers.size(); ++i) sorted_.emplace_back(numbers[i], i);
    std::sort(sorted_.begin(), sorted_.end());
    const auto repeated = std::adjacent_find(sorted_.begin(), sorted_.end(),
                                             [](const auto& a, const auto& b) { return a.first == b.first; });
    if (repeated != sorted_.end()) return twice(repeated->first);
    return {};
}

std::uint64_t NumberMap::find_sorted(std::int64_t number) const noexcept {
    const auto found =
        std::lower_bound(sorted_.begin(), sorted_.end(), std::pair<std::int64_t, std::uint64_t>(number, 0));
    return found != sorted_.end() && found->first == number ? found->second : none;
}

} // namespace isotet::io
