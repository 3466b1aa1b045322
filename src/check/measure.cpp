// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "check/measure.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "base/parallel.hpp"
#include "numbers/exact.hpp"

namespace isotet::checking {

namespace {

/// One component of a cross product, and a bound of what rounding may have done to it.
struct Minor {
    double value, bound;
    Minor(double a, double b, double c, double d)
        : value(a * d - b * c), bound(0x1p-50 * (std::abs(a * d) + std::abs(b * c))) {}
    bool surely_not_zero() const { return std::abs(value) > bound && bound > 0x1p-900; }
};

/// Twice the area of a triangle.
struct TwiceArea {
    double value;
    bool may_be_zero; ///< exactly: rounding does not tell
};
TwiceArea twice_area(const core::Point& a, const core::Point& b, const core::Point& c) {
    const double ux = b[0] - a[0], uy = b[1] - a[1], uz = b[2] - a[2];
    const double vx = c[0] - a[0], vy = c[1] - a[1], vz = c[2] - a[2];
    const Minor x(uy, uz, vy, vz), y(uz, ux, vz, vx), z(ux, uy, vx, vy);
    return {std::sqrt(x.value * x.value + y.value * y.value + z.value * z.value),
            !x.surely_not_zero() && !y.surely_not_zero() && !z.surely_not_zero()};
}

constexpr std::uint64_t block_size = 4096; ///< triangles that are summed up one after another
std::size_t blocks_of(std::uint64_t triangles) {
    return static_cast<std::size_t>((triangles + block_size - 1) / block_size);
}
std::pair<std::uint64_t, std::uint64_t> block_of(std::size_t block, std::uint64_t triangles) {
    return {block * block_size, std::min(triangles, (block + 1) * block_size)};
}

double six_volumes(const core::Point& a, const core::Point& b, const core::Point& c) {
    return a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
}

} // namespace

Measures measure(const Mesh& mesh, std::size_t most) {
    if (mesh.triangles() == 0) return {};
    const core::Point base = mesh.position(mesh.corners(0)[0]);
    std::vector<Measures> blocks(blocks_of(mesh.triangles()));
    core::parallel_each(blocks.size(), 1, [&](std::size_t i) {
        Measures& block = blocks[i];
        const auto [begin, end] = block_of(i, mesh.triangles());
        for (std::uint64_t triangle = begin; triangle < end; ++triangle) {
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
            const core::Point a = mesh.position(corners[0]), b = mesh.position(corners[1]),
                              c = mesh.position(corners[2]);
            const TwiceArea twice = twice_area(a, b, c);
            block.area += twice.value;
            block.volume += six_volumes(p[0], p[1], p[2]);
            if (!twice.may_be_zero || !core::is_collinear(a, b, c)) continue;
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

double area(const Surface& surface, const Run& run) {
    const auto mesh = checking::Mesh::open(surface);
    if (!mesh) return std::numeric_limits<double>::quiet_NaN();
    const std::uint64_t triangles = mesh->triangles();
    std::vector<double> blocks(checking::blocks_of(triangles));
    const auto measure = [&](const auto* positions, const auto* corners) {
        const auto point = [&](std::uint64_t corner) {
            const auto* const p = positions + 3 * static_cast<std::size_t>(corners[corner]);
            return core::Point{p[0], p[1], p[2]};
        };
        core::parallel_pieces(blocks.size(), 1, run.progress, [&](std::size_t block, std::size_t) {
            double sum = 0;
            const auto [begin, end] = checking::block_of(block, triangles);
            for (std::uint64_t t = begin; t < end; ++t)
                sum += checking::twice_area(point(3 * t), point(3 * t + 1), point(3 * t + 2)).value;
            blocks[block] = sum;
        });
    };
    core::with_threads(run.threads, [&] {
        core::IndexColumn(surface.triangles).visit([&](const auto* corners) {
            if (surface.positions.type() == ScalarType::float32) measure(surface.positions.as<float>().data(), corners);
            else measure(surface.positions.as<double>().data(), corners);
        });
    });
    if (run.progress.cancelled()) return std::numeric_limits<double>::quiet_NaN();
    return std::accumulate(blocks.begin(), blocks.end(), 0.0) / 2;
}

} // namespace isotet
