// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <isotet/array.hpp>

namespace isotet::linear {

/// Which cells and faces isovalues cut or touch.
class CutRule {
public:
    /// `values`   one scalar a point; borrowed
    CutRule(const Array& values, std::span<const double> isovalues)
        : values_(values), isovalues_(isovalues.begin(), isovalues.end()) {
        if (values.type() == ScalarType::float32) singles_ = values.as<float>().data();
        if (values.type() == ScalarType::float64) doubles_ = values.as<double>().data();
        std::ranges::sort(isovalues_);
    }

    /// By its points. False where a value is no number.
    bool cuts(std::span<const std::uint64_t> points) const {
        constexpr double most = std::numeric_limits<double>::infinity();
        double lowest = most, highest = -most;
        for (const std::uint64_t point : points) {
            const double value = singles_ ? singles_[point] : doubles_ ? doubles_[point] : values_.at(point);
            if (std::isnan(value)) return false;
            lowest = std::min(lowest, value);
            highest = std::max(highest, value);
        }
        // An isovalue is stored as the nearest value of the field's type.
        constexpr double rounding = 0x1p-20;
        const double more = rounding * std::max(std::abs(lowest), std::abs(highest));
        const auto next = std::ranges::lower_bound(isovalues_, lowest - more);
        return next != isovalues_.end() && *next <= highest + more;
    }

private:
    const Array& values_;
    const float* singles_ = nullptr;  ///< values_, where it is of this type
    const double* doubles_ = nullptr; ///< the same
    std::vector<double> isovalues_;   ///< ascending
};

} // namespace isotet::linear
