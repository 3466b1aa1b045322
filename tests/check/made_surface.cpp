// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "check/made_surface.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace isotet::test {

Soup& Soup::add(const Soup& other) {
    const auto first = static_cast<std::uint32_t>(vertices.size());
    vertices.insert(vertices.end(), other.vertices.begin(), other.vertices.end());
    for (const auto& [a, b, c] : other.triangles) triangles.push_back({a + first, b + first, c + first});
    return *this;
}

Soup Soup::moved(float x, float y, float z) const {
    Soup result = *this;
    for (auto& v : result.vertices) v = {v[0] + x, v[1] + y, v[2] + z};
    return result;
}

Soup Soup::mirrored() const {
    Soup result = *this;
    for (auto& t : result.triangles) std::swap(t[1], t[2]);
    return result;
}

Surface surface_of(const Soup& soup) {
    std::vector<float> positions;
    for (const auto& v : soup.vertices) positions.insert(positions.end(), v.begin(), v.end());
    std::vector<std::uint32_t> triangles;
    for (const auto& t : soup.triangles) triangles.insert(triangles.end(), t.begin(), t.end());
    Surface surface;
    surface.positions = Array::own(std::move(positions), 3);
    surface.triangles = Array::own(std::move(triangles), 3);
    return surface;
}

SurfaceReport check_of(const Soup& soup, const CheckOptions& options) {
    return check(surface_of(soup), options).value();
}

Soup octahedron() {
    return {{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
            {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}};
}

Soup torus(std::uint32_t n) {
    Soup soup;
    const double step = 2 * std::numbers::pi / n;
    for (std::uint32_t i = 0; i < n; ++i)
        for (std::uint32_t j = 0; j < n; ++j) {
            const double radius = 2 + std::cos(j * step);
            soup.vertices.push_back({static_cast<float>(radius * std::cos(i * step)),
                                     static_cast<float>(radius * std::sin(i * step)),
                                     static_cast<float>(std::sin(j * step))});
            const std::uint32_t a = i * n + j, b = (i + 1) % n * n + j;
            const std::uint32_t c = (i + 1) % n * n + (j + 1) % n, d = i * n + (j + 1) % n;
            soup.triangles.push_back({a, b, c});
            soup.triangles.push_back({a, c, d});
        }
    return soup;
}

Soup square() { return {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}}; }

bool has_finding(const SurfaceReport& report, const std::string& beginning) {
    return std::ranges::any_of(report.findings, [&](const Finding& f) { return f.what.starts_with(beginning); });
}

} // namespace isotet::test
