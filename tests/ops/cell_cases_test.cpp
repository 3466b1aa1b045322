// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The case tables of pyramids, wedges and hexahedra, all of them: what is drawn on a face follows from the signs of its
// corners alone, and ties leave no hole.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "grid/cell/cell_cases.hpp"
#include "reference/triangles.hpp"

namespace isotet::test {
namespace {

using core::CellKind;

/// A vertex of a case: an edge by its corners, lower first; twice the same for a tied corner.
using CaseVertex = std::pair<std::uint8_t, std::uint8_t>;
using CaseTriangle = std::array<CaseVertex, 3>;

CaseVertex vertex_of(const core::ActiveEdge& edge, unsigned tied) {
    if (tied >> edge.above & 1) return {edge.above, edge.above};
    return {std::min(edge.above, edge.below), std::max(edge.above, edge.below)};
}

/// The triangles with three different corners.
std::vector<CaseTriangle> triangles_of(CellKind kind, unsigned index, unsigned tied = 0) {
    std::vector<CaseTriangle> out;
    for (const auto& t : reference::triangles_of(kind, index)) {
        const CaseTriangle v{vertex_of(t[0], tied), vertex_of(t[1], tied), vertex_of(t[2], tied)};
        if (v[0] != v[1] && v[1] != v[2] && v[2] != v[0]) out.push_back(v);
    }
    return out;
}

/// Directed edges that are not cancelled by opposite ones, and how often.
std::map<std::pair<CaseVertex, CaseVertex>, int> rim_of(const std::vector<CaseTriangle>& triangles) {
    std::map<std::pair<CaseVertex, CaseVertex>, int> rim;
    for (const CaseTriangle& t : triangles)
        for (std::size_t k = 0; k < 3; ++k) {
            const CaseVertex a = t[k], b = t[(k + 1) % 3];
            if (auto opposite = rim.find({b, a}); opposite != rim.end()) {
                if (--opposite->second == 0) rim.erase(opposite);
            } else {
                ++rim[{a, b}];
            }
        }
    return rim;
}

bool is_on(const core::CellFace& face, const CaseVertex& vertex) {
    const auto all = face.all();
    return std::ranges::find(all, vertex.first) != all.end() && std::ranges::find(all, vertex.second) != all.end();
}

/// A segment of a face by places among its corners, as seen from outside of the cell.
using Segment = std::array<std::size_t, 4>;

std::set<Segment> segments_on(CellKind kind, const core::CellFace& face, unsigned index, std::size_t turned) {
    const auto place = [&](std::uint8_t corner) {
        const auto all = face.all();
        const auto at = static_cast<std::size_t>(std::ranges::find(all, corner) - all.begin());
        return (at + face.count - turned) % face.count;
    };
    const auto places = [&](const CaseVertex& v) {
        const std::size_t a = place(v.first), b = place(v.second);
        return std::pair(std::min(a, b), std::max(a, b));
    };
    std::set<Segment> out;
    for (const auto& [edge, times] : rim_of(triangles_of(kind, index)))
        if (is_on(face, edge.first) && is_on(face, edge.second)) {
            const auto [a, b] = places(edge.first);
            const auto [c, d] = places(edge.second);
            out.insert({a, b, c, d});
        }
    return out;
}

/// Which of a face's corners are above, from the corner `turned` on.
unsigned signs_on(const core::CellFace& face, unsigned index, std::size_t turned) {
    unsigned signs = 0;
    for (std::size_t k = 0; k < face.count; ++k) signs |= (index >> face.corners[(k + turned) % face.count] & 1) << k;
    return signs;
}

TEST(CellCases, HaveTheirRimsOnFaces) {
    for (const CellKind kind : core::cell_kinds)
        for (unsigned index = 0; index < 1u << core::corner_count(kind); ++index)
            for (const auto& [edge, times] : rim_of(triangles_of(kind, index))) {
                int faces = 0;
                for (const core::CellFace& face : core::shape_of(kind).faces())
                    faces += is_on(face, edge.first) && is_on(face, edge.second);
                EXPECT_EQ(faces, 1) << int(kind) << " " << index;
                EXPECT_EQ(times, 1);
            }
}

TEST(CellCases, DrawOnAFaceWhatItsSignsSay) {
    // By the number of corners and their signs: the segments, whatever the kind, the face and where it begins.
    std::map<std::pair<std::size_t, unsigned>, std::set<Segment>> drawn;
    for (const CellKind kind : core::cell_kinds)
        for (const core::CellFace& face : core::shape_of(kind).faces())
            for (unsigned index = 0; index < 1u << core::corner_count(kind); ++index)
                for (std::size_t turned = 0; turned < face.count; ++turned) {
                    const std::pair<std::size_t, unsigned> key{face.count, signs_on(face, index, turned)};
                    const std::set<Segment> segments = segments_on(kind, face, index, turned);
                    EXPECT_EQ(drawn.try_emplace(key, segments).first->second, segments) << int(kind) << " " << index;
                }
    EXPECT_EQ(drawn.size(), 8u + 16u);
    // Seen from the other side, by the neighbour, corners run the other way round, and so do segments.
    for (const auto& [key, segments] : drawn) {
        const auto& [count, signs] = key;
        unsigned mirrored_signs = 0;
        for (std::size_t k = 0; k < count; ++k) mirrored_signs |= (signs >> k & 1) << (count - 1 - k);
        std::set<Segment> mirrored;
        for (const Segment& s : segments)
            mirrored.insert({count - 1 - s[3], count - 1 - s[2], count - 1 - s[1], count - 1 - s[0]});
        EXPECT_EQ((drawn.at({count, mirrored_signs})), mirrored) << count << " " << signs;
    }
}

TEST(CellCases, HaveTheTrianglesOfMarchingCubes) {
    std::size_t sum = 0, most = 0;
    for (unsigned index = 0; index < 256; ++index) {
        sum += core::hexahedron_cases.cases[index].triangles;
        most = std::max<std::size_t>(most, core::hexahedron_cases.cases[index].triangles);
    }
    EXPECT_EQ(sum, 820u); // as Lorensen and Cline's table
    EXPECT_EQ(most, 5u);
}

/// Corners of upright cells, each convex.
std::vector<std::array<double, 3>> places_of(CellKind kind) {
    switch (kind) {
    case CellKind::tetrahedron: return {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    case CellKind::pyramid: return {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.4, 0.6, 1}};
    case CellKind::wedge: return {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {0, 0, 1}, {0, 1, 1}, {1, 0, 1}};
    default: return {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
    }
}

TEST(CellCases, AreSeenCounterClockwiseFromAbove) {
    for (const CellKind kind : core::cell_kinds) {
        const auto places = places_of(kind);
        for (int direction = 0; direction < 60; ++direction) {
            const std::array<double, 3> up{std::cos(direction), std::sin(1.7 * direction),
                                           std::cos(2.3 * direction + 1)};
            std::vector<double> heights;
            for (const auto& p : places) heights.push_back(up[0] * p[0] + up[1] * p[1] + up[2] * p[2]);
            for (const double level : {-0.4, 0.05, 0.3, 0.8}) {
                unsigned index = 0;
                for (std::size_t k = 0; k < places.size(); ++k) index |= unsigned{heights[k] >= level} << k;
                for (const CaseTriangle& t : triangles_of(kind, index)) {
                    std::array<std::array<double, 3>, 3> corners;
                    for (std::size_t k = 0; k < 3; ++k) {
                        const auto& [a, b] = t[k];
                        const double part = (level - heights[a]) / (heights[b] - heights[a]);
                        for (std::size_t axis = 0; axis < 3; ++axis)
                            corners[k][axis] = places[a][axis] + part * (places[b][axis] - places[a][axis]);
                    }
                    double rise = 0;
                    for (std::size_t axis = 0; axis < 3; ++axis) {
                        const std::size_t j = (axis + 1) % 3, k = (axis + 2) % 3;
                        rise += up[axis] * ((corners[1][j] - corners[0][j]) * (corners[2][k] - corners[0][k]) -
                                            (corners[1][k] - corners[0][k]) * (corners[2][j] - corners[0][j]));
                    }
                    EXPECT_GT(rise, 0) << int(kind) << " " << index;
                }
            }
        }
    }
}

/// Calls f(index, tied) for every way in which corners are below, tied or above; tied ones are in both.
template <class F>
void for_states(CellKind kind, const F& f) {
    unsigned states = 1;
    for (std::size_t k = 0; k < core::corner_count(kind); ++k) states *= 3;
    for (unsigned state = 0; state < states; ++state) {
        unsigned index = 0, tied = 0, rest = state;
        for (unsigned k = 0; k < core::corner_count(kind); ++k, rest /= 3) {
            index |= unsigned{rest % 3 != 0} << k;
            tied |= unsigned{rest % 3 == 1} << k;
        }
        f(index, tied);
    }
}

TEST(CellCases, HaveTheirRimsOnFacesWithTies) {
    for (const CellKind kind : core::cell_kinds)
        for_states(kind, [&](unsigned index, unsigned tied) {
            for (const auto& [edge, times] : rim_of(triangles_of(kind, index, tied))) {
                bool on_a_face = false;
                for (const core::CellFace& face : core::shape_of(kind).faces())
                    on_a_face |= is_on(face, edge.first) && is_on(face, edge.second);
                EXPECT_TRUE(on_a_face) << int(kind) << " " << index << " " << tied;
            }
        });
}

TEST(CellCases, UseEveryEdgeFromBelowToStrictlyAbove) {
    for (const CellKind kind : core::cell_kinds)
        for_states(kind, [&](unsigned index, unsigned tied) {
            std::set<CaseVertex> used;
            for (const CaseTriangle& t : triangles_of(kind, index, tied)) used.insert(t.begin(), t.end());
            for (const core::CellFace& face : core::shape_of(kind).faces())
                for (std::size_t k = 0; k < face.count; ++k) {
                    const std::uint8_t a = face.corners[k], b = face.corners[(k + 1) % face.count];
                    const unsigned above = index & ~tied;
                    const bool is_active =
                        ((above >> a & 1) && !(index >> b & 1)) || ((above >> b & 1) && !(index >> a & 1));
                    EXPECT_TRUE(!is_active || used.contains({std::min(a, b), std::max(a, b)}));
                }
        });
}

} // namespace
} // namespace isotet::test
