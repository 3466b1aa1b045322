// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "core/packed.hpp"

#include <cmath>

namespace isotet::core {

namespace {

template <class Real>
std::uint8_t quantize_in(Real value, Range<Real> range) {
    const Real width = range.upper - range.lower;
    if (!(width > 0) || !(value > range.lower)) return 0;
    if (value >= range.upper) value = range.upper;
    // width is in [2^e, 2^(e+1)): times 2^(7-e) it is below 256.
    const Real step = std::scalbn(Real(1), 7 - std::ilogb(width));
    return static_cast<std::uint8_t>(std::min((value - range.lower) * step, Real(255)));
}

} // namespace

std::uint8_t quantize(float value, Range<float> range) { return quantize_in(value, range); }
std::uint8_t quantize(double value, Range<double> range) { return quantize_in(value, range); }

} // namespace isotet::core
