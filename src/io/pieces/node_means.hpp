// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Values that cells give at their nodes, each its own, as a point field.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <isotet/export.hpp>

namespace isotet::io {

/// Means of what cells give at their nodes.
class ISOTET_API NodeMeans {
public:
    NodeMeans(std::uint64_t points, std::size_t components);

    /// One more cell at this point.
    void count(std::uint64_t point) { ++counts_[point]; }
    /// Its values.
    void add(std::uint64_t point, std::size_t component, double value);

    /// The value that all cells give, else their mean; NaN where no cell gave one.
    std::vector<double> means() const;

    /// A note on values that differ by more than rounding; empty where none does. `source` says what has them:
    /// "each cell (ELNO)".
    std::string note(std::string_view field, std::string_view source) const;

private:
    double largest_difference() const;
    double lowest() const;
    double highest() const;

    std::size_t components_;
    std::vector<double> sums_, lowest_, highest_;
    std::vector<std::uint32_t> counts_;
};

} // namespace isotet::io
