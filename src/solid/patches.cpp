// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "solid/patches.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "base/parallel.hpp"
#include "grid/cell_faces.hpp"
#include "grid/cells.hpp"
#include "grid/patches.hpp"

namespace isotet::solid {

namespace {

/// Faces by one of their points, a row a point.
class FacesOfPoints {
public:
    /// `each(add)` calls add(point, face) for what goes in, twice.
    template <class Each>
    FacesOfPoints(std::size_t points, const Each& each) : first_(points + 1) {
        each([&](std::uint64_t point, std::size_t) { ++first_[point + 1]; });
        for (std::size_t point = 0; point < points; ++point) first_[point + 1] += first_[point];
        faces_.resize(first_.back());
        std::vector<std::uint64_t> next(first_.begin(), first_.end() - 1);
        each([&](std::uint64_t point, std::size_t face) { faces_[next[point]++] = face; });
    }
    /// Ascending.
    std::span<const std::size_t> of(std::uint64_t point) const {
        if (point + 1 >= first_.size()) return {};
        return std::span(faces_).subspan(first_[point], first_[point + 1] - first_[point]);
    }

private:
    std::vector<std::uint64_t> first_;
    std::vector<std::size_t> faces_;
};

void append_row(const DerivedPoints& derived, std::uint64_t row, std::vector<std::uint64_t>& out) {
    const auto first = derived.first.as<std::uint64_t>();
    for (std::uint64_t i = first[row]; i < first[row + 1]; ++i)
        if (derived.weights.empty() || derived.weights.as<double>()[i] != 0)
            out.push_back(derived.points.as<std::uint64_t>()[i]);
}

/// The user's points that points of a linear grid are made of.
class Origins {
public:
    explicit Origins(const LinearGrid* linear) : linear_(linear) {}

    void append(std::uint64_t point, std::vector<std::uint64_t>& out) const {
        if (!linear_ || point < linear_->user_points) return out.push_back(point);
        const std::uint64_t row = point - linear_->user_points;
        if (row < linear_->derived.count()) append_row(linear_->derived, row, out);
        else append_refined(row - linear_->derived.count(), out);
    }

private:
    /// A point inside a quadratic tet, or on a face or an edge of it: the nodes there.
    void append_refined(std::uint64_t row, std::vector<std::uint64_t>& out) const {
        static constexpr std::array<std::array<std::size_t, 2>, 6> edges{
            {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};
        constexpr std::uint32_t whole = std::uint32_t{1} << 30;
        const RefinedPoints& refined = linear_->refined;
        const auto place = refined.places.as<std::uint32_t>().subspan(3 * row, 3);
        const std::array<bool, 4> counts{place[0] != 0, place[1] != 0, place[2] != 0,
                                         std::uint64_t{place[0]} + place[1] + place[2] != whole};
        const std::size_t tet = refined.parents.as<std::uint32_t>()[row];
        const auto nodes = refined.nodes.as<std::uint32_t>().subspan(10 * tet, 10);
        for (std::size_t k = 0; k < 4; ++k)
            if (counts[k]) append_node(nodes[k], out);
        for (std::size_t k = 0; k < edges.size(); ++k)
            if (counts[edges[k][0]] && counts[edges[k][1]]) append_node(nodes[4 + k], out);
    }

    void append_node(std::uint32_t node, std::vector<std::uint64_t>& out) const {
        const std::uint64_t points = linear_->user_points + linear_->derived.count();
        if (node == std::numeric_limits<std::uint32_t>::max()) return;
        if (node < points) append(node, out);
        else append_row(linear_->refined.hidden, node - points, out);
    }

    const LinearGrid* linear_;
};

/// Calls use(points of a face, ascending) for the faces of polyhedra.
template <class Use>
void for_faces_of_polyhedra(const core::CellReader& cells, const core::FaceReader& faces, const Use& use) {
    std::vector<std::uint64_t> points;
    for (std::size_t cell = 0; cell < cells.count(); ++cell) {
        if (cells.type(cell) != core::polyhedron_type) continue;
        for (std::uint64_t at = faces.begin(cell) + 1; at < faces.end(cell);) {
            const std::uint64_t end = at + 1 + faces.at(at);
            points.clear();
            for (++at; at < end; ++at) points.push_back(faces.at(at));
            std::ranges::sort(points);
            use(points);
        }
    }
}

} // namespace

void PatchFaces::add(std::vector<std::uint64_t> points, std::int64_t patch, std::int64_t cell) {
    std::ranges::sort(points);
    const auto [end, last] = std::ranges::unique(points);
    points.erase(end, last);
    if (points.size() < 3) return;
    points_.insert(points_.end(), points.begin(), points.end());
    offsets_.push_back(points_.size());
    marks_.push_back({patch, cell});
}

Result<PatchFaces> PatchFaces::of(const Grid& grid) {
    if (auto sound = core::check_patches(grid); !sound) return sound.error();
    const auto cells = core::CellReader::open(grid);
    if (!cells) return cells.error();
    PatchFaces out;
    std::vector<std::uint64_t> points;
    for (std::size_t face = 0; face < grid.patches.count(); ++face) {
        const auto begin = grid.patches.offsets.as<std::int64_t>()[face],
                   end = grid.patches.offsets.as<std::int64_t>()[face + 1];
        points.clear();
        for (std::int64_t i = begin; i < end; ++i)
            points.push_back(
                static_cast<std::uint64_t>(grid.patches.points.as<std::int64_t>()[static_cast<std::size_t>(i)]));
        out.add(points, grid.patches.numbers.as<std::int64_t>()[face], -1);
    }
    for (std::size_t cell = 0; cells->has_types() && cell < cells->count(); ++cell) {
        if (!core::is_flat_cell(cells->type(cell))) continue;
        const std::uint64_t first = cells->first(cell), count = cells->corners(cell);
        if (count > cells->connectivity_size() || first > cells->connectivity_size() - count) continue;
        points.clear();
        for (std::uint64_t i = first; i < first + count; ++i) points.push_back(cells->corner(i));
        if (std::ranges::all_of(points, [&](std::uint64_t point) { return point < cells->points(); }))
            out.add(points, -1, static_cast<std::int64_t>(cell));
    }
    if (!out.empty()) out.grow_to_polyhedra(grid);
    return out;
}

/// Cells with hanging points have more points on a face than the patch that is there.
void PatchFaces::grow_to_polyhedra(const Grid& grid) {
    if (grid.cells.faces.empty()) return;
    const auto cells = core::CellReader::open(grid);
    const auto faces = core::FaceReader::open(grid.cells);
    if (!cells || !faces || !core::check_faces(grid, *cells, {})) return;
    const FacesOfPoints by_lowest(grid.points.tuples(), [&](const auto& add_one) {
        for (std::size_t face = 0; face < marks_.size(); ++face) add_one(points_of(face).front(), face);
    });
    std::vector<std::vector<std::uint64_t>> grown(marks_.size());
    for_faces_of_polyhedra(*cells, *faces, [&](const std::vector<std::uint64_t>& points) {
        for (const std::uint64_t point : points)
            for (const std::size_t face : by_lowest.of(point))
                if (points_of(face).size() < points.size() && std::ranges::includes(points, points_of(face)))
                    grown[face] = points;
    });
    PatchFaces out;
    for (std::size_t face = 0; face < marks_.size(); ++face) {
        const auto own = points_of(face);
        out.add(grown[face].empty() ? std::vector(own.begin(), own.end()) : grown[face], marks_[face].patch,
                marks_[face].cell);
    }
    *this = std::move(out);
}

bool PatchFaces::has_all(std::size_t face, std::span<const std::uint64_t> points) const {
    return std::ranges::all_of(points,
                               [&](std::uint64_t point) { return std::ranges::binary_search(points_of(face), point); });
}

void PatchFaces::match(const LinearGrid* linear, BoundaryFaces& boundary) const {
    if (empty()) return;
    const std::uint64_t last = *std::ranges::max_element(points_);
    const FacesOfPoints by_point(last + 1, [&](const auto& add_one) {
        for (std::size_t face = 0; face < marks_.size(); ++face)
            for (const std::uint64_t point : points_of(face)) add_one(point, face);
    });
    const Origins origins(linear);
    core::parallel_ranges(boundary.faces.size(), 1 << 12, [&](std::size_t begin, std::size_t end) {
        std::vector<std::uint64_t> points;
        for (std::size_t i = begin; i < end; ++i) {
            BoundaryFace& face = boundary.faces[i];
            points.clear();
            for (const std::uint32_t place : face.all()) origins.append(boundary.points[place], points);
            if (points.empty()) continue;
            for (const std::size_t patch : by_point.of(points.front())) {
                const bool is_wanted = marks_[patch].patch >= 0 ? face.mark.patch < 0 : face.mark.cell < 0;
                if (!is_wanted || !has_all(patch, points)) continue;
                if (marks_[patch].patch >= 0) face.mark.patch = marks_[patch].patch;
                else face.mark.cell = marks_[patch].cell;
            }
        }
    });
}

} // namespace isotet::solid
