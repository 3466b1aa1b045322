// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/pieces/node_means.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/core.h>

#include "io/files/text_scanner.hpp"

namespace isotet::io {

NodeMeans::NodeMeans(std::uint64_t points, std::size_t components)
    : components_(components),
      sums_(points * components),
      lowest_(points * components, std::numeric_limits<double>::infinity()),
      highest_(points * components, -std::numeric_limits<double>::infinity()),
      counts_(points) {}

void NodeMeans::add(std::uint64_t point, std::size_t component, double value) {
    const std::size_t at = point * components_ + component;
    sums_[at] += value;
    lowest_[at] = std::min(lowest_[at], value);
    highest_[at] = std::max(highest_[at], value);
}

std::vector<double> NodeMeans::means() const {
    std::vector<double> means(sums_.size(), std::numeric_limits<double>::quiet_NaN());
    for (std::size_t point = 0; point < counts_.size(); ++point)
        for (std::size_t c = point * components_; counts_[point] > 0 && c < (point + 1) * components_; ++c)
            means[c] = lowest_[c] == highest_[c] && !std::isnan(sums_[c])
                           ? lowest_[c]
                           : sums_[c] / static_cast<double>(counts_[point]);
    return means;
}

std::string NodeMeans::note(std::string_view field, std::string_view source) const {
    constexpr double rounding = 1e-10; ///< of the largest value
    const double largest = largest_difference();
    if (!(largest > rounding * std::max(std::abs(lowest()), std::abs(highest())))) return {};
    return fmt::format("point field {} has a value for each node of {}: at each node the mean was taken of values that "
                       "differ by up to {:.6g}, of a range from {:.6g} to {:.6g}",
                       in_quotes(field), source, largest, lowest(), highest());
}

double NodeMeans::largest_difference() const {
    double largest = 0;
    for (std::size_t c = 0; c < sums_.size(); ++c)
        if (highest_[c] > lowest_[c]) largest = std::max(largest, highest_[c] - lowest_[c]);
    return largest;
}

double NodeMeans::lowest() const {
    return lowest_.empty() ? std::numeric_limits<double>::quiet_NaN() : *std::ranges::min_element(lowest_);
}

double NodeMeans::highest() const {
    return highest_.empty() ? std::numeric_limits<double>::quiet_NaN() : *std::ranges::max_element(highest_);
}

} // namespace isotet::io
