// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "grid/points/hanging.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <span>
#include <utility>

#include <tbb/parallel_sort.h>

#include <isotet/grid.hpp>

#include "base/carry_out.hpp"
#include "base/system/memory.hpp"
#include "base/parallel.hpp"
#include "grid/orientation.hpp"
#include "grid/points/same_place.hpp"

namespace isotet::core {

namespace {

constexpr double smaller_share = 0.75; // of the area; two triangles on a quadrilateral are as large
constexpr double most_cosine = -0.5;   // cosine between normals
constexpr double rim = 0.05;           // of barycentric coordinates outside
constexpr double in_plane = 1e-5;      // of the longest edge
constexpr double beside_plane = 0.2;   // likewise, of curved shapes

Point from_to(const Point& a, const Point& b) { return {b[0] - a[0], b[1] - a[1], b[2] - a[2]}; }
double dot_product(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Point cross_product(const Point& a, const Point& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// A face by places, turned outward, with twice its area along the normal.
struct PlacedFace {
    std::array<std::uint32_t, 3> corners;
    std::uint32_t given; ///< which of those that were given
    Point normal;

    bool has(std::uint32_t place) const { return std::ranges::find(corners, place) != corners.end(); }
    std::array<std::uint32_t, 3> key() const {
        std::array<std::uint32_t, 3> sorted = corners;
        std::ranges::sort(sorted);
        return sorted;
    }
};

class HangingFinder {
public:
    /// Where it is cancelled, what is found is of no use.
    HangingFinder(const Array& points, const std::vector<BoundaryFace>& faces, const Progress& progress)
        : given_(faces), progress_(progress) {
        number_places(points);
        if (!progress_.cancelled()) place_faces();
        if (!progress_.cancelled()) drop_matched();
        if (!progress_.cancelled()) connect();
    }

    HangingFaces find() {
        std::vector<std::uint8_t> hangs(places_.size(), 0), lies(given_.size(), 0);
        const auto mark = [](std::uint8_t& flag) {
            std::atomic_ref<std::uint8_t>(flag).store(1, std::memory_order_relaxed);
        };
        if (progress_.cancelled()) return {};
        parallel_pieces(faces_.size(), 1 << 10, progress_, [&](std::size_t begin, std::size_t end) {
            std::vector<std::uint32_t> on;
            for (std::size_t face = begin; face < end; ++face) {
                find_smaller(static_cast<std::uint32_t>(face), on);
                for (const std::uint32_t other : on) {
                    mark(lies[faces_[face].given]);
                    mark(lies[faces_[other].given]);
                    for (const std::uint32_t place : faces_[other].corners)
                        if (!faces_[face].has(place)) mark(hangs[place]);
                }
            }
        });
        HangingFaces out;
        if (progress_.cancelled()) return out;
        out.points = static_cast<std::uint64_t>(std::ranges::count(hangs, 1));
        for (std::size_t i = 0; i < given_.size(); ++i)
            if (lies[i]) out.faces.push_back(given_[i].points);
        tbb::parallel_sort(out.faces.begin(), out.faces.end());
        return out;
    }

private:
    const Point& at(std::uint32_t place) const { return places_[place]; }

    void number_places(const Array& points) {
        used_.reserve(3 * given_.size());
        for (const BoundaryFace& face : given_) used_.insert(used_.end(), face.points.begin(), face.points.end());
        tbb::parallel_sort(used_.begin(), used_.end());
        if (progress_.cancelled()) return;
        used_.erase(std::unique(used_.begin(), used_.end()), used_.end());
        places_.resize(used_.size());
        const PointReader reader(points);
        parallel_each(used_.size(), 1 << 14, [&](std::size_t i) { places_[i] = reader[used_[i]]; });
        std::vector<double> coordinates(3 * used_.size());
        for (std::size_t i = 0; i < used_.size(); ++i) std::ranges::copy(places_[i], coordinates.begin() + 3 * i);
        lowest_ = lowest_at_same_place(Array::own(std::move(coordinates), 3));
    }

    void place_faces() {
        faces_.resize(given_.size());
        parallel_each(given_.size(), 1 << 12, [&](std::size_t i) {
            PlacedFace& face = faces_[i];
            face.given = static_cast<std::uint32_t>(i);
            for (std::size_t k = 0; k < 3; ++k) {
                const auto used = std::ranges::lower_bound(used_, given_[i].points[k]);
                face.corners[k] = static_cast<std::uint32_t>(lowest_[static_cast<std::size_t>(used - used_.begin())]);
            }
            if (given_[i].mirrored) std::swap(face.corners[1], face.corners[2]);
            face.normal = cross_product(from_to(at(face.corners[0]), at(face.corners[1])),
                                        from_to(at(face.corners[0]), at(face.corners[2])));
        });
    }

    /// Faces on the same places match, whatever their points' numbers.
    void drop_matched() {
        tbb::parallel_sort(faces_.begin(), faces_.end(), [](const PlacedFace& a, const PlacedFace& b) {
            const auto first = a.key(), second = b.key();
            return first != second ? first < second : a.given < b.given;
        });
        std::size_t kept = 0;
        for (std::size_t begin = 0, end = 0; begin < faces_.size(); begin = end) {
            end = begin + 1;
            while (end < faces_.size() && faces_[end].key() == faces_[begin].key()) ++end;
            if (end == begin + 1 && dot_product(faces_[begin].normal, faces_[begin].normal) > 0)
                faces_[kept++] = faces_[begin];
        }
        faces_.resize(kept);
    }

    void connect() {
        first_.assign(places_.size() + 1, 0);
        for (const PlacedFace& face : faces_)
            for (const std::uint32_t place : face.corners) ++first_[place + 1];
        std::partial_sum(first_.begin(), first_.end(), first_.begin());
        around_.resize(3 * faces_.size());
        std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
        for (std::uint32_t i = 0; i < faces_.size(); ++i)
            for (const std::uint32_t place : faces_[i].corners) around_[next[place]++] = i;
    }
    std::span<const std::uint32_t> faces_at(std::uint32_t place) const {
        return {around_.data() + first_[place], first_[place + 1] - first_[place]};
    }

    double longest_edge(const PlacedFace& face) const {
        const auto& [a, b, c] = face.corners;
        return std::sqrt(
            std::max({squared_distance(at(a), at(b)), squared_distance(at(b), at(c)), squared_distance(at(c), at(a))}));
    }

    /// How far the centroid of a smaller face that faces the other way is from the plane of a face, in longest edges;
    /// infinite when it is not over the face.
    double height_over(const PlacedFace& face, const PlacedFace& other) const {
        const double area = std::sqrt(dot_product(face.normal, face.normal));
        const double other_area = std::sqrt(dot_product(other.normal, other.normal));
        if (!(other_area < smaller_share * area)) return INFINITY;
        if (!(dot_product(face.normal, other.normal) < most_cosine * area * other_area)) return INFINITY;
        Point centroid{};
        for (const std::uint32_t place : other.corners)
            for (std::size_t axis = 0; axis < 3; ++axis) centroid[axis] += at(place)[axis] / 3;
        for (std::size_t k = 0; k < 3; ++k) {
            const Point &a = at(face.corners[k]), &b = at(face.corners[(k + 1) % 3]);
            const double inside = dot_product(cross_product(from_to(a, b), from_to(a, centroid)), face.normal);
            if (!(inside >= -rim * area * area)) return INFINITY;
        }
        const double height = dot_product(from_to(at(face.corners[0]), centroid), face.normal) / area;
        return std::abs(height) / longest_edge(face);
    }

    /// The faces that lie on a face, from its corners on.
    void find_smaller(std::uint32_t number, std::vector<std::uint32_t>& on) const {
        const PlacedFace& face = faces_[number];
        on.clear();
        bool beside = false;
        const auto look_around = [&](std::uint32_t place) {
            for (const std::uint32_t other : faces_at(place)) {
                if (other == number) continue;
                const double height = height_over(face, faces_[other]);
                if (!(height <= beside_plane) || std::ranges::find(on, other) != on.end()) continue;
                beside |= height > in_plane;
                on.push_back(other);
            }
        };
        for (const std::uint32_t place : face.corners) look_around(place);
        for (std::size_t next = 0; next < on.size(); ++next)
            for (const std::uint32_t place : faces_[on[next]].corners)
                if (!face.has(place)) look_around(place);
        if (beside && !has_middle(face, on))
            std::erase_if(on, [&](std::uint32_t other) { return height_over(face, faces_[other]) > in_plane; });
    }

    /// Whether a point of some faces lies between two corners of a face, and is connected with both.
    bool has_middle(const PlacedFace& face, const std::vector<std::uint32_t>& on) const {
        const auto connected = [&](std::uint32_t a, std::uint32_t b) {
            return std::ranges::any_of(on, [&](std::uint32_t i) { return faces_[i].has(a) && faces_[i].has(b); });
        };
        for (const std::uint32_t i : on)
            for (const std::uint32_t middle : faces_[i].corners)
                for (std::size_t k = 0; k < 3 && !face.has(middle); ++k) {
                    const std::uint32_t a = face.corners[k], b = face.corners[(k + 1) % 3];
                    Point off{};
                    for (std::size_t axis = 0; axis < 3; ++axis)
                        off[axis] = at(middle)[axis] - (at(a)[axis] + at(b)[axis]) / 2;
                    if (dot_product(off, off) <= beside_plane * beside_plane * squared_distance(at(a), at(b)) &&
                        connected(a, middle) && connected(middle, b))
                        return true;
                }
        return false;
    }

    const std::vector<BoundaryFace>& given_;
    const Progress& progress_;
    std::vector<std::uint64_t> used_, lowest_; ///< points of faces, ascending; the first of them at the same place
    std::vector<Point> places_;
    std::vector<PlacedFace> faces_;
    std::vector<std::size_t> first_; ///< faces around places
    std::vector<std::uint32_t> around_;
};

} // namespace

Result<HangingFaces> find_hanging(const Array& points, const std::vector<BoundaryFace>& faces,
                                  const Progress& progress) {
    HangingFaces found = HangingFinder(points, faces, progress).find();
    if (progress.cancelled()) return Error{ErrorCode::cancelled, "looking for hanging points was cancelled"};
    return found;
}

Result<HangingFaces> find_hanging(const Grid& grid, const CellReader& cells, const Progress& progress) {
    constexpr std::uint64_t enough_for_small_grids = 1 << 26, most_faces = 1 << 22;
    const TetSurvey tets = survey_tets(grid, cells, progress);
    if (progress.cancelled()) return Error{ErrorCode::cancelled, "looking for hanging points was cancelled"};
    FaceSurveyOptions options;
    options.memory = std::max(free_memory() / 4, enough_for_small_grids);
    options.most_faces = std::max(tets.tets, most_faces); // more are cells that do not meet at all
    const auto faces = survey_faces(grid, cells, tets, options, progress);
    if (!faces) return faces.error();
    return find_hanging(grid.points, faces->faces, progress);
}

} // namespace isotet::core
