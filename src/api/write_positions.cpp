// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include <isotet/surface.hpp>

#include "base/carry_out.hpp"
#include "base/errors.hpp"
#include "base/parallel.hpp"

namespace isotet {

namespace {

constexpr std::size_t position_grain = 1 << 15;

template <class Real>
void write_relative(std::span<const Real> positions, const std::array<double, 3>& origin, std::span<float> out) {
    core::parallel_ranges(positions.size() / 3, position_grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t at = 3 * begin; at < 3 * end; at += 3)
            for (std::size_t axis = 0; axis < 3; ++axis)
                out[at + axis] = static_cast<float>(static_cast<double>(positions[at + axis]) - origin[axis]);
    });
}

} // namespace

Result<void> write_positions(const Surface& surface, const std::array<double, 3>& origin, std::span<float> out,
                             const Run& run) {
    return core::carry_out("writing positions", run, [&](const Progress&) -> Result<void> {
        const Array& positions = surface.positions;
        if (out.size() != positions.size())
            return invalid_argument(fmt::format("there is room for {} numbers, but the surface has {} vertices of 3",
                                                out.size(), surface.vertex_count()));
        if (!std::ranges::all_of(origin, [](double one) { return std::isfinite(one); }))
            return invalid_argument("the origin is not finite");
        if (positions.empty()) return {};
        if (positions.type() == ScalarType::float32) write_relative(positions.as<float>(), origin, out);
        else if (positions.type() == ScalarType::float64) write_relative(positions.as<double>(), origin, out);
        else return invalid_data("the surface's positions are not float32 or float64");
        return {};
    });
}

} // namespace isotet
