// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/isosurface_scene.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

namespace isotet {

Array stretched(const Array& points, std::span<const double, 3> factors) {
    return points.visit([&]<class Scalar>(std::span<const Scalar> scalars) {
        std::vector<Scalar> out(scalars.size());
        for (std::size_t i = 0; i < out.size(); ++i)
            out[i] = static_cast<Scalar>(static_cast<double>(scalars[i]) * factors[i % 3]);
        return Array::own(std::move(out), 3);
    });
}

Plane stretched(const Plane& plane, std::span<const double, 3> factors) {
    Plane out = plane;
    for (std::size_t axis = 0; axis < 3; ++axis) out.normal[axis] /= factors[axis];
    return out;
}

bool is_of_reservoirs(std::string_view format) noexcept { return format == "grdecl"; }

std::optional<std::array<double, 3>> default_stretch(const Array& points) {
    constexpr double flat = 50, seen = 4;
    const auto ranges = statistics_of(points);
    if (!ranges || ranges->size() != 3 || (*ranges)[0].lower > (*ranges)[0].upper) return {};
    const auto extent = [&](std::size_t axis) { return (*ranges)[axis].upper - (*ranges)[axis].lower; };
    const double width = std::max(extent(0), extent(1)), height = extent(2);
    if (!(height > 0) || width < flat * height) return {};
    const double most = width / height / seen, power = std::pow(10, std::floor(std::log10(most)));
    return std::array{1.0, 1.0, (most < 2 * power ? 1 : most < 5 * power ? 2 : 5) * power};
}

} // namespace isotet
