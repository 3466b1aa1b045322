// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "solid/warped_face.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "numbers/exact.hpp"

namespace isotet::solid {

namespace {

double scalar_product(const Place3& a, const Place3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

double triple_product(const Place3& a, const Place3& b, const Place3& c) {
    return a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
}

} // namespace

Polygon polygon_of(std::span<const Place3> corners) {
    Polygon out;
    for (std::size_t k = 0; k < corners.size(); ++k) {
        const Place3 &a = corners[k], &b = corners[(k + 1) % corners.size()];
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const std::size_t next = (axis + 1) % 3, last = (axis + 2) % 3;
            out.mean[axis] += a[axis] / static_cast<double>(corners.size());
            out.area[axis] += (a[next] * b[last] - a[last] * b[next]) / 2;
        }
    }
    out.volume = scalar_product(out.area, out.mean) / 3;
    return out;
}

bool is_warped(std::span<const Place3, 4> corners, double distance) {
    const Polygon polygon = polygon_of(corners);
    const double area = std::hypot(polygon.area[0], polygon.area[1], polygon.area[2]);
    return std::abs(core::six_volumes(corners[0], corners[1], corners[2], corners[3])) > distance * area;
}

double largest_coordinate(std::span<const Place3> places) {
    double largest = 0;
    for (const Place3& place : places)
        for (const double x : place) largest = std::max(largest, std::abs(x));
    return largest;
}

Place3 apex_of(const Polygon& polygon, double volume) {
    const double square = scalar_product(polygon.area, polygon.area);
    if (square == 0) return polygon.mean;
    const double along = 3 * (volume - polygon.volume) / square;
    Place3 out = polygon.mean;
    for (std::size_t axis = 0; axis < 3; ++axis) out[axis] += along * polygon.area[axis];
    return out;
}

std::array<double, 4> weights_of(std::span<const Place3, 4> corners, const Place3& vector) {
    std::array<Place3, 3> edges;
    for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t axis = 0; axis < 3; ++axis) edges[k][axis] = corners[k + 1][axis] - corners[0][axis];
    const double determinant = triple_product(edges[0], edges[1], edges[2]);
    std::array<double, 4> out{};
    if (determinant == 0) return out;
    out[1] = triple_product(vector, edges[1], edges[2]) / determinant;
    out[2] = triple_product(edges[0], vector, edges[2]) / determinant;
    out[3] = triple_product(edges[0], edges[1], vector) / determinant;
    out[0] = -(out[1] + out[2] + out[3]);
    return out;
}

void share_difference(double whole, std::span<const Polygon> parts, std::span<double> volumes) {
    const auto size = [](const Polygon& part) { // a volume as wide as the part
        const double area = std::sqrt(scalar_product(part.area, part.area));
        return area * std::sqrt(area);
    };
    double sum = 0, sizes = 0;
    for (const Polygon& part : parts) {
        sum += part.volume;
        sizes += size(part);
    }
    for (std::size_t i = 0; i < parts.size(); ++i)
        volumes[i] = parts[i].volume + (sizes > 0 ? (whole - sum) * (size(parts[i]) / sizes) : 0);
}

} // namespace isotet::solid
