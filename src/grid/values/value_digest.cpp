// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "grid/values/value_digest.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace isotet::core {

void ValueDigest::add(double value) {
    if (std::isnan(value)) {
        no_data_ = true;
        return;
    }
    if (std::isinf(value)) {
        whole_.insert(value);
        return;
    }
    lower_ = std::min(lower_, value);
    upper_ = std::max(upper_, value);
    if (value > 0) least_positive_ = std::min(least_positive_, value);
    if (fraction_) return;
    if (value != std::floor(value)) fraction_ = value;
    else if (whole_.size() < most_whole_numbers) whole_.insert(value);
}

void ValueDigest::add(const Array& values, std::span<const std::uint8_t> left_out) {
    values.visit([&]<class Scalar>(std::span<const Scalar> scalars) {
        std::optional<Scalar> last;
        for (std::size_t i = 0; i < scalars.size(); ++i) {
            if (last == scalars[i] || (!left_out.empty() && left_out[i] != 0)) continue;
            last = scalars[i];
            add(static_cast<double>(scalars[i]));
        }
    });
}

Array ValueDigest::values() const {
    std::vector<double> all(whole_.begin(), whole_.end());
    if (lower_ <= upper_) all.insert(all.end(), {lower_, upper_});
    if (std::isfinite(least_positive_)) all.push_back(least_positive_);
    if (fraction_) all.push_back(*fraction_);
    if (no_data_) all.push_back(std::numeric_limits<double>::quiet_NaN());
    return Array::own(std::move(all));
}

} // namespace isotet::core
