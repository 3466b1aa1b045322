// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// A few of many values that tell what colours of all go by.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <set>
#include <span>

#include <isotet/array.hpp>
#include <isotet/export.hpp>

namespace isotet::core {

/// Of values that go by: the least and the greatest that are finite, the least above 0, one that is NaN, those that are
/// infinite, one that is no whole number, and whole numbers, up to 13.
class ISOTET_API ValueDigest {
public:
    static constexpr std::size_t most_whole_numbers = 13;

    /// Scalars; `left_out`: empty, or nonzero for those that do not count.
    void add(const Array& values, std::span<const std::uint8_t> left_out);

    /// Each of these that there is, as float64.
    Array values() const;

private:
    void add(double value);

    static constexpr double infinity = std::numeric_limits<double>::infinity();
    double lower_ = infinity, upper_ = -infinity, least_positive_ = infinity;
    bool no_data_ = false;
    std::optional<double> fraction_;
    std::set<double> whole_;
};

} // namespace isotet::core
