// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Marching pyramids, wedges and hexahedra: which triangles a cell gives, by which of its corners are above.
//
// On each face the runs of corners above are cut off. So what is drawn on a face follows from the signs of its corners
// alone, and neighbours agree whatever their kinds. The segments on the faces make loops. A loop is a fan from the
// lowest of its edges, by (lower, higher) corner, from which no diagonal lies in a face: there the neighbour might have
// the same one, and four triangles would meet in it. Triangles are counter-clockwise seen from above, for an upright cell.
// VTK's tables give as many triangles in each case.
//
// A fan is stored in polygons of one or two triangles, as the cases of tets are (case_table.hpp): (0, 1, 2) and
// (0, 2, 3) of its four edges.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "grid/cell/case_table.hpp"
#include "grid/cell/cell_kind.hpp"

namespace isotet::core {

struct CellPolygon {
    std::array<ActiveEdge, 4> edges{}; ///< around; the fourth repeats the third when there is one triangle
    std::uint8_t triangles = 0;        ///< 1 or 2
};

/// The most polygons that a cell gives.
inline constexpr std::size_t max_cell_polygons = 4;

struct CellCase {
    std::uint16_t first = 0; ///< of its polygons
    std::uint8_t polygons = 0, triangles = 0;
};

namespace detail {

/// The polygons of one case.
struct CasePolygons {
    std::array<CellPolygon, max_cell_polygons> polygons{};
    std::size_t count = 0;
};

/// An edge by its two corners.
constexpr std::uint8_t edge_code(std::uint8_t a, std::uint8_t b) {
    return static_cast<std::uint8_t>(8 * std::min(a, b) + std::max(a, b));
}

/// By edge code: a bit for each face that has the edge.
constexpr std::array<std::uint8_t, 64> faces_of_edges(CellKind kind) {
    std::array<std::uint8_t, 64> out{};
    std::uint8_t bit = 1;
    for (const CellFace& face : shape_of(kind).faces()) {
        for (std::size_t k = 0; k < face.count; ++k)
            out[edge_code(face.corners[k], face.corners[(k + 1) % face.count])] |= bit;
        bit = static_cast<std::uint8_t>(2 * bit);
    }
    return out;
}

/// The edges around one part of a surface in a cell, the lowest first.
struct Loop {
    std::array<ActiveEdge, 12> edges{};
    std::array<std::uint8_t, 12> codes{};
    std::size_t count = 0;

    constexpr std::size_t after(std::size_t place, std::size_t steps) const {
        return place + steps < count ? place + steps : place + steps - count;
    }
    /// Whether all diagonals from an edge lie inside of the cell.
    constexpr bool is_apex(const std::array<std::uint8_t, 64>& faces, std::size_t apex) const {
        for (std::size_t k = 2; k + 1 < count; ++k)
            if (faces[codes[apex]] & faces[codes[after(apex, k)]]) return false;
        return true;
    }
    /// The lowest of those edges. A loop begins with its lowest edge, so it is mostly the first.
    constexpr std::size_t apex(const std::array<std::uint8_t, 64>& faces) const {
        std::size_t lowest = count;
        for (std::size_t k = 0; k < count; ++k)
            if ((lowest == count || codes[k] < codes[lowest]) && is_apex(faces, k)) lowest = k;
        return lowest; // `count` if there is none, which no case has
    }
};

constexpr CasePolygons polygons_of_case(CellKind kind, const std::array<std::uint8_t, 64>& faces, unsigned index) {
    constexpr std::uint8_t none = 255;
    const auto is_above = [index](std::uint8_t corner) { return (index >> corner & 1) != 0; };
    std::array<std::uint8_t, 64> next{}; // the segment that begins on an edge ends on this one
    next.fill(none);
    for (const CellFace& face : shape_of(kind).faces()) {
        std::array<std::uint8_t, 4> crossings{};
        std::array<bool, 4> upward{};
        std::size_t count = 0;
        for (std::size_t k = 0; k < face.count; ++k) {
            const std::uint8_t a = face.corners[k], b = face.corners[(k + 1) % face.count];
            if (is_above(a) == is_above(b)) continue;
            crossings[count] = edge_code(a, b);
            upward[count++] = is_above(b);
        }
        for (std::size_t k = 0; k < count; ++k)
            if (upward[k]) next[crossings[(k + 1) % count]] = crossings[k];
    }
    CasePolygons out;
    for (std::uint8_t start = 0; start < next.size(); ++start) {
        if (next[start] == none) continue;
        Loop loop;
        for (std::uint8_t edge = start; next[edge] != none;) {
            const auto lower = static_cast<std::uint8_t>(edge / 8), higher = static_cast<std::uint8_t>(edge % 8);
            loop.codes[loop.count] = edge;
            loop.edges[loop.count++] = is_above(lower) ? ActiveEdge{lower, higher} : ActiveEdge{higher, lower};
            const std::uint8_t following = next[edge];
            next[edge] = none;
            edge = following;
        }
        const std::size_t apex = loop.apex(faces);
        if (apex == loop.count) throw "a loop has no edge from which all diagonals lie inside";
        for (std::size_t k = 1; k + 1 < loop.count; k += 2) {
            CellPolygon& polygon = out.polygons[out.count++];
            const bool two = k + 2 < loop.count;
            polygon.triangles = two ? 2 : 1;
            for (std::size_t edge = 0; edge < 4; ++edge) {
                const std::size_t steps = edge == 0 ? 0 : edge == 3 && !two ? k + 1 : k + edge - 1;
                polygon.edges[edge] = loop.edges[loop.after(apex, steps)];
            }
        }
    }
    return out;
}

/// Made once, in an evaluation of its own: compilers count steps.
template <CellKind kind>
inline constexpr auto polygons_of_cases = [] {
    std::array<CasePolygons, std::size_t{1} << corner_count(kind)> out{};
    const auto faces = faces_of_edges(kind);
    for (unsigned index = 0; index < out.size(); ++index) out[index] = polygons_of_case(kind, faces, index);
    return out;
}();

template <CellKind kind>
constexpr std::size_t count_polygons() {
    std::size_t sum = 0;
    for (const CasePolygons& of_case : polygons_of_cases<kind>) sum += of_case.count;
    return sum;
}

} // namespace detail

/// All cases of a kind, by the sum over above corners k of 2^k.
template <CellKind kind>
struct CellCases {
    static constexpr std::size_t case_count = std::size_t{1} << corner_count(kind);
    static constexpr std::size_t polygon_count = detail::count_polygons<kind>();

    std::array<CellCase, case_count> cases{};
    std::array<CellPolygon, polygon_count> all{};

    constexpr CellCases() {
        std::size_t next = 0;
        for (unsigned index = 0; index < case_count; ++index) {
            const detail::CasePolygons& of_case = detail::polygons_of_cases<kind>[index];
            CellCase& c = cases[index];
            c.first = static_cast<std::uint16_t>(next);
            c.polygons = static_cast<std::uint8_t>(of_case.count);
            for (std::size_t k = 0; k < of_case.count; ++k) {
                all[next++] = of_case.polygons[k];
                c.triangles = static_cast<std::uint8_t>(c.triangles + of_case.polygons[k].triangles);
            }
        }
    }
    constexpr std::span<const CellPolygon> polygons(unsigned index) const {
        return {all.data() + cases[index].first, cases[index].polygons};
    }
};

inline constexpr CellCases<CellKind::pyramid> pyramid_cases{};
inline constexpr CellCases<CellKind::wedge> wedge_cases{};
inline constexpr CellCases<CellKind::hexahedron> hexahedron_cases{};

template <CellKind kind>
constexpr const auto& cases_of() {
    if constexpr (kind == CellKind::pyramid) return pyramid_cases;
    else if constexpr (kind == CellKind::wedge) return wedge_cases;
    else return hexahedron_cases;
}

/// The polygons of a cell that is not a tet.
constexpr std::span<const CellPolygon> polygons_of(CellKind kind, unsigned index) {
    switch (kind) {
    case CellKind::pyramid: return pyramid_cases.polygons(index);
    case CellKind::wedge: return wedge_cases.polygons(index);
    default: return hexahedron_cases.polygons(index);
    }
}

} // namespace isotet::core
