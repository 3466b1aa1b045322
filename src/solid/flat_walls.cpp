// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "solid/flat_walls.hpp"

#include <algorithm>
#include <array>
#include <compare>
#include <utility>

#include <tbb/parallel_sort.h>

#include "grid/surface_rows.hpp"
#include "solid/warped_face.hpp"

namespace isotet::solid {

namespace {

using Vertex = std::uint32_t; // of the solid
using Corners = std::array<Vertex, 3>;

/// A triangle by its vertices, ascending, and whether these turn it round.
struct Sheet {
    Corners corners;
    bool turned = false;
    bool taken = false;
    std::uint64_t number = 0; ///< of the triangle

    friend bool operator<(const Sheet& a, const Sheet& b) {
        if (a.corners != b.corners) return a.corners < b.corners;
        return a.turned != b.turned ? b.turned : a.number < b.number;
    }
};

Sheet sheet_of(Corners corners, std::uint64_t number) {
    std::ranges::rotate(corners, std::ranges::min_element(corners));
    const bool turned = corners[1] > corners[2];
    if (turned) std::swap(corners[1], corners[2]);
    return {corners, turned, false, number};
}

/// A directed edge of a sheet, and the third corner.
struct Side {
    Vertex from, to, third;

    friend bool operator<(const Side& a, const Side& b) {
        return std::array{a.from, a.to, a.third} < std::array{b.from, b.to, b.third};
    }
};

/// Triangles of which some may lie back to back.
class Sheets {
public:
    static constexpr std::uint64_t of_others = ~std::uint64_t{0};

    void add(const Corners& corners, std::uint64_t number) { sheets_.push_back(sheet_of(corners, number)); }

    void pair_triangles() {
        tbb::parallel_sort(sheets_.begin(), sheets_.end());
        for (std::size_t begin = 0, end = 0; begin < sheets_.size(); begin = end) {
            std::size_t turned = begin;
            while (turned < sheets_.size() && sheets_[turned].corners == sheets_[begin].corners &&
                   !sheets_[turned].turned)
                ++turned;
            for (end = turned; end < sheets_.size() && sheets_[end].corners == sheets_[begin].corners;) ++end;
            for (std::size_t i = 0; i < std::min(turned - begin, end - turned); ++i)
                sheets_[begin + i].taken = sheets_[turned + i].taken = true;
        }
        drop_taken();
    }

    /// abc and acd with adb and bdc: both sides of a quadrilateral abcd, by its two diagonals.
    /// `is_flat(corners)`   of four vertices
    template <class IsFlat>
    void pair_quadrilaterals(const IsFlat& is_flat) {
        std::vector<Side> sides;
        sides.reserve(3 * sheets_.size());
        for (const Sheet& sheet : sheets_) {
            Corners at = sheet.corners;
            if (sheet.turned) std::swap(at[1], at[2]);
            for (std::size_t k = 0; k < 3; ++k) sides.push_back({at[k], at[(k + 1) % 3], at[(k + 2) % 3]});
        }
        tbb::parallel_sort(sides.begin(), sides.end());
        const auto along = [&](Vertex from, Vertex to) {
            return std::ranges::equal_range(sides, std::pair(from, to), {},
                                            [](const Side& side) { return std::pair(side.from, side.to); });
        };
        for (const auto& [c, a, b] : sides) {
            if (c < a) continue; // seen from the other side
            for (const Side& across : along(a, c)) {
                const Vertex d = across.third;
                if (d == b || along(b, d).empty() || !is_flat(std::array{a, b, c, d})) continue;
                take_all({{{a, b, c}, {a, c, d}, {a, d, b}, {b, d, c}}});
            }
        }
        drop_taken();
    }

    std::vector<std::uint64_t> taken() && {
        std::ranges::sort(taken_);
        return std::move(taken_);
    }

private:
    void take_all(const std::array<Corners, 4>& triangles) {
        std::array<Sheet*, 4> found{};
        for (std::size_t i = 0; i < 4; ++i) {
            const Sheet wanted = sheet_of(triangles[i], 0);
            auto at = std::lower_bound(sheets_.begin(), sheets_.end(), wanted);
            while (at != sheets_.end() && at->corners == wanted.corners && at->turned == wanted.turned && at->taken)
                ++at;
            if (at == sheets_.end() || at->corners != wanted.corners || at->turned != wanted.turned) return;
            found[i] = &*at;
        }
        for (Sheet* sheet : found) sheet->taken = true;
    }

    void drop_taken() {
        for (const Sheet& sheet : sheets_)
            if (sheet.taken && sheet.number != of_others) taken_.push_back(sheet.number);
        std::erase_if(sheets_, [](const Sheet& sheet) { return sheet.taken; });
    }

    std::vector<Sheet> sheets_; ///< ascending once triangles are paired
    std::vector<std::uint64_t> taken_;
};

/// A vertex by the ends of its edge, both the point where this is tied, and by which isosurface it is of.
struct Name {
    std::int64_t below = 0, above = 0;
    bool of_upper = false;

    bool is_tied() const { return below == above; }
    auto operator<=>(const Name&) const = default;
};

std::vector<Name> names_of(std::span<const Shell> shells) {
    std::vector<Name> names;
    for (const Shell& shell : shells) {
        if (shell.surface.vertex_count() == 0) continue;
        const auto ends = shell.surface.edge_ends.as<std::int64_t>();
        for (std::size_t i = 0; i < ends.size(); i += 2) names.push_back({ends[i], ends[i + 1], !shell.mirrored});
    }
    return names;
}

/// The vertices of another shell by those of the solid with the same names.
class Translation {
public:
    static constexpr Vertex nowhere = ~Vertex{0};

    explicit Translation(const std::vector<Name>& names) {
        for (std::size_t i = 0; i < names.size(); ++i) numbers_.push_back({names[i], static_cast<Vertex>(i)});
        tbb::parallel_sort(numbers_.begin(), numbers_.end());
    }

    Vertex operator()(const Name& name) const {
        const auto found = std::ranges::lower_bound(numbers_, name, {}, &std::pair<Name, Vertex>::first);
        return found != numbers_.end() && found->first == name ? found->second : nowhere;
    }

private:
    std::vector<std::pair<Name, Vertex>> numbers_;
};

void add_others(std::span<const Shell> others, const std::vector<Name>& names, Sheets& out) {
    const Translation translation(names);
    for (const Shell& shell : others) {
        std::vector<Vertex> vertices;
        for (const Name& name : names_of(std::span(&shell, 1))) vertices.push_back(translation(name));
        if (vertices.empty()) continue;
        const auto triangles = shell.surface.triangles.as<std::uint32_t>();
        for (std::size_t i = 0; i < triangles.size(); i += 3) {
            Corners corners{vertices[triangles[i]], vertices[triangles[i + 1]], vertices[triangles[i + 2]]};
            if (shell.mirrored) std::swap(corners[1], corners[2]);
            if (std::ranges::find(corners, Translation::nowhere) == corners.end()) out.add(corners, Sheets::of_others);
        }
    }
}

} // namespace

bool has_tied_vertices(std::span<const Shell> shells) { return std::ranges::any_of(names_of(shells), &Name::is_tied); }

std::vector<std::uint64_t> triangles_of_flat_walls(const Surface& solid, std::span<const Shell> shells,
                                                   std::span<const Shell> others) {
    const std::vector<Name> names = names_of(shells);
    Sheets sheets;
    const auto triangles = solid.triangles.as<std::uint32_t>();
    for (std::size_t i = 0; i < solid.triangle_count(); ++i) {
        const Corners corners{triangles[3 * i], triangles[3 * i + 1], triangles[3 * i + 2]};
        // Those of a flat wall are at vertices of isosurfaces, of which one at least is tied.
        if (std::ranges::max(corners) < names.size() &&
            std::ranges::any_of(corners, [&](Vertex vertex) { return names[vertex].is_tied(); }))
            sheets.add(corners, i);
    }
    if (!others.empty()) add_others(others, names, sheets);
    sheets.pair_triangles();
    const double rounding = rounding_of(solid.positions.type());
    sheets.pair_quadrilaterals([&](const std::array<Vertex, 4>& corners) {
        std::array<Place3, 4> places;
        for (std::size_t k = 0; k < 4; ++k)
            for (std::size_t axis = 0; axis < 3; ++axis) places[k][axis] = solid.positions.at(corners[k], axis);
        return !is_warped(places, rounding * largest_coordinate(places));
    });
    return std::move(sheets).taken();
}

Surface without_triangles(const Surface& surface, std::span<const std::uint64_t> out) {
    std::vector<std::uint64_t> triangles;
    auto next = out.begin();
    for (std::uint64_t i = 0; i < surface.triangle_count(); ++i)
        if (next != out.end() && *next == i) ++next;
        else triangles.push_back(i);
    return core::with_triangles(surface, triangles);
}

} // namespace isotet::solid
