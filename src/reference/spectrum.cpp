// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "reference/spectrum.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace isotet::reference {

namespace {

struct Corner {
    core::Point place;
    double value;
};
using SortedTet = std::array<Corner, 4>; // by value

core::Point difference(const core::Point& a, const core::Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

core::Point cross_product(const core::Point& a, const core::Point& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

double triangle_area(const core::Point& a, const core::Point& b, const core::Point& c) {
    const core::Point n = cross_product(difference(b, a), difference(c, a));
    return std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]) / 2;
}

double tet_volume(const core::Point& a, const core::Point& b, const core::Point& c, const core::Point& d) {
    const core::Point n = cross_product(difference(b, a), difference(c, a)), e = difference(d, a);
    return std::abs(n[0] * e[0] + n[1] * e[1] + n[2] * e[2]) / 6;
}

/// Where the field has the isovalue between a corner below and one above.
core::Point cut(const Corner& below, const Corner& above, double isovalue) {
    const double part = (isovalue - below.value) / (above.value - below.value);
    core::Point place;
    for (std::size_t axis = 0; axis < 3; ++axis)
        place[axis] = below.place[axis] + part * (above.place[axis] - below.place[axis]);
    return place;
}

struct Cut {
    double area = 0, below = 0;
};

Cut cut_tet(const SortedTet& t, double isovalue) {
    const auto below = std::ranges::count_if(t, [&](const Corner& corner) { return corner.value < isovalue; });
    const auto point = [&](std::size_t low, std::size_t high) { return cut(t[low], t[high], isovalue); };
    const double whole = tet_volume(t[0].place, t[1].place, t[2].place, t[3].place);
    if (below == 0) return {};
    if (below == 4) return {0, whole};
    if (below == 1) {
        const core::Point a = point(0, 1), b = point(0, 2), c = point(0, 3);
        return {triangle_area(a, b, c), tet_volume(t[0].place, a, b, c)};
    }
    if (below == 3) {
        const core::Point a = point(0, 3), b = point(1, 3), c = point(2, 3);
        return {triangle_area(a, b, c), whole - tet_volume(t[3].place, a, b, c)};
    }
    // A wedge between corners 0 and 1, of three tets.
    const core::Point a = point(0, 2), b = point(0, 3), c = point(1, 3), d = point(1, 2);
    return {triangle_area(a, b, c) + triangle_area(a, c, d), tet_volume(t[0].place, a, b, t[1].place) +
                                                                 tet_volume(a, b, t[1].place, d) +
                                                                 tet_volume(b, t[1].place, d, c)};
}

} // namespace

ops::Spectrum contour_spectrum(const ops::SpectrumInput& input) {
    const std::size_t count = input.isovalues.size();
    ops::Spectrum out{std::vector<double>(count), std::vector<double>(count), 0, 0, 0};
    input.cells.for_cells(0, input.cells.count(), [&](std::size_t, const core::CellTets& tets) {
        for (const core::Tet& corners : tets) {
            SortedTet tet;
            for (std::size_t k = 0; k < 4; ++k) tet[k] = {input.points[corners[k]], input.values[corners[k]]};
            if (std::ranges::any_of(tet, [](const Corner& corner) { return std::isnan(corner.value); })) {
                ++out.no_data_tets;
                continue;
            }
            std::ranges::stable_sort(tet, {}, &Corner::value);
            ++out.tets;
            out.volume += tet_volume(tet[0].place, tet[1].place, tet[2].place, tet[3].place);
            for (std::size_t i = 0; i < count; ++i) {
                const Cut part = cut_tet(tet, input.isovalues[i]);
                out.area[i] += part.area;
                out.volume_below[i] += part.below;
            }
        }
    });
    return out;
}

} // namespace isotet::reference
