// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "check/measure.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/exact.hpp"
#include "core/parallel.hpp"

namespace isotet::checking {

namespace {

/// One component of a cross product, and a bound of what rounding may have done to it.
struct Minor {
    double value, bound;
    Minor(double a, double b, double c, double d)
        : value(a * d - b * c), bound(0x1p-50 * (std::abs(a * d) + std::abs(b * c))) {}
    bool surely_not_zero() const { return std::abs(value) > bound && bound > 0x1p-900; }
};

/// Twice the area; `is_zero` tells whether it is exactly zero.
double twice_area(const core::Point& a, const core::Point& b, const core::Point& c, bool& is_zero) {
    const double ux = b[0] - a[0], uy = b[1] - a[1], uz = b[2] - a[2];
    const double vx = c[0] - a[0], vy = c[1] - a[1], vz = c[2] - a[2];
    const Minor x(uy, uz, vy, vz), y(uz, ux, vz, vx), z(ux, uy, vx, vy);
    is_zero = !x.surely_not_zero() && !y.surely_not_zero() && !z.surely_not_zero() && core::is_collinear(a, b, c);
    return std::sqrt(x.value * x.value + y.value * y.value + z.value * z.value);
}

double six_volumes(const core::Point& a, const core::Point& b, const core::Point& c) {
    return a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
}

} // namespace

Measures measure(const Mesh& mesh, std::size_t most) {
    constexpr std::size_t block_size = 4096;
    if (mesh.triangles() == 0) return {};
    const core::Point base = mesh.position(mesh.corners(0)[0]);
    std::vector<Measures> blocks((mesh.triangles() - 1) / block_size + 1);
    core::parallel_each(blocks.size(), 1, [&](std::size_t i) {
        Measures& block = blocks[i];
        const std::uint64_t end = std::min<std::uint64_t>(mesh.triangles(), (i + 1) * block_size);
        for (std::uint64_t triangle = i * block_size; triangle < end; ++triangle) {
            const Corners corners = mesh.corners(triangle);
            if (has_equal_corners(corners)) {
                ++block.equal_corners;
                if (block.equal_corners_list.size() < most) block.equal_corners_list.push_back(triangle);
                continue;
            }
            std::array<core::Point, 3> p;
            for (std::size_t corner = 0; corner < 3; ++corner) {
                p[corner] = mesh.position(corners[corner]);
                for (std::size_t axis = 0; axis < 3; ++axis) p[corner][axis] -= base[axis];
            }
            bool is_zero = false;
            block.area +=
                twice_area(mesh.position(corners[0]), mesh.position(corners[1]), mesh.position(corners[2]), is_zero);
            block.volume += six_volumes(p[0], p[1], p[2]);
            if (!is_zero) continue;
            ++block.zero_area;
            if (block.zero_area_list.size() < most) block.zero_area_list.push_back(triangle);
        }
    });
    const auto append = [&](std::vector<std::uint64_t>& few, const std::vector<std::uint64_t>& more) {
        few.insert(few.end(), more.begin(),
                   more.begin() + static_cast<std::ptrdiff_t>(std::min(more.size(), most - few.size())));
    };
    Measures sum;
    for (const Measures& block : blocks) {
        sum.area += block.area;
        sum.volume += block.volume;
        sum.equal_corners += block.equal_corners;
        sum.zero_area += block.zero_area;
        append(sum.equal_corners_list, block.equal_corners_list);
        append(sum.zero_area_list, block.zero_area_list);
    }
    sum.area /= 2;
    sum.volume /= 6;
    return sum;
}

} // namespace isotet::checking

namespace isotet {

double area(const Surface& surface) {
    const auto mesh = checking::Mesh::open(surface);
    return mesh ? checking::measure(*mesh, 0).area : std::numeric_limits<double>::quiet_NaN();
}

} // namespace isotet
