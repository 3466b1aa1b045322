// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "linear/polyhedra/centre.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "linear/derived.hpp"
#include "linear/vector.hpp"

namespace isotet::linear {

namespace {

constexpr int max_moves = 200;
constexpr double thinnest =
    1e-18; // squared area over the fourth power of the longest edge: no place can see such a triangle

/// The outer side of a triangle's plane.
struct Wall {
    Point normal; ///< of length 1
    Point corner;
};

class CentreFinder {
public:
    CentreFinder(std::span<const std::uint64_t> points, std::span<const OutwardTriangle> triangles,
                 const core::PointReader& places, bool single)
        : points_(points), triangles_(triangles), places_(places), single_(single) {}

    Centre find() {
        Centre out;
        out.weights.assign(points_.size(), 1 / static_cast<double>(points_.size()));
        mean_ = place_of(out.weights);
        if (accept(rounded(mean_), out)) return out;
        for (const double depth : {1e-2, 1e-4}) {
            const auto moved = weights_of(moved_inside(depth));
            if (!moved || !accept(rounded(place_of(*moved)), out)) continue;
            out.weights = *moved;
            out.moved = true;
            return out;
        }
        out.place = rounded(mean_);
        out.folded = true;
        return out;
    }

private:
    Point place_of(const std::vector<double>& weights) const {
        Point out;
        for (std::size_t axis = 0; axis < 3; ++axis)
            out[axis] = weighted_sum(
                points_.size(), [&](std::size_t i) { return weights[i]; },
                [&](std::size_t i) { return places_[points_[i]][axis]; });
        return out;
    }

    Point rounded(Point place) const {
        if (single_)
            for (double& x : place) x = static_cast<float>(x);
        return place;
    }

    static bool is_thin(const Point& a, const Point& b, const Point& c) {
        const Point normal = cross(minus(b, a), minus(c, a));
        const double longest =
            std::max({core::squared_distance(a, b), core::squared_distance(b, c), core::squared_distance(c, a)});
        return !(dot(normal, normal) > thinnest * longest * longest);
    }

    /// False when the tet over a triangle with an area is not upright.
    bool accept(const Point& place, Centre& out) const {
        bool sees_all = true;
        for (const OutwardTriangle& t : triangles_) {
            const Point a = places_[t[0]], b = places_[t[1]], c = places_[t[2]];
            if (core::orientation_sign(a, c, b, place) > 0) continue;
            if (!is_thin(a, b, c)) return false;
            sees_all = false;
        }
        out.place = place;
        out.sees_all = sees_all;
        return true;
    }

    /// From the mean over the worst wall to `depth` times the cell's size behind it, again and again.
    Point moved_inside(double depth) const {
        std::vector<Wall> walls;
        double size = 0;
        for (const OutwardTriangle& t : triangles_) {
            const Point a = places_[t[0]], b = places_[t[1]], c = places_[t[2]];
            size = std::max(size, std::sqrt(core::squared_distance(a, mean_)));
            if (is_thin(a, b, c)) continue;
            Point normal = cross(minus(b, a), minus(c, a));
            const double length = std::sqrt(dot(normal, normal));
            for (double& x : normal) x /= length;
            walls.push_back({normal, a});
        }
        Point place = mean_;
        for (int move = 0; move < max_moves; ++move) {
            const Wall* worst = nullptr;
            double most = 0;
            for (const Wall& wall : walls) {
                const double outside = dot(wall.normal, minus(place, wall.corner)) + depth * size;
                if (outside > most) {
                    most = outside;
                    worst = &wall;
                }
            }
            if (!worst) break;
            for (std::size_t axis = 0; axis < 3; ++axis) place[axis] -= most * worst->normal[axis];
        }
        return place;
    }

    /// Equal weights, and of all changes that lead to the place the least. Nothing where the points lie in a plane.
    std::optional<std::vector<double>> weights_of(const Point& place) const {
        Point rows[3] = {};
        for (const std::uint64_t point : points_) {
            const Point arm = minus(places_[point], mean_);
            for (std::size_t r = 0; r < 3; ++r)
                for (std::size_t c = 0; c < 3; ++c) rows[r][c] += arm[r] * arm[c];
        }
        const Point way = minus(place, mean_);
        const double determinant = dot(rows[0], cross(rows[1], rows[2]));
        const double trace = rows[0][0] + rows[1][1] + rows[2][2];
        if (!(determinant > 1e-15 * trace * trace * trace)) return std::nullopt;
        // The matrix is symmetric: Cramer's rule by its rows.
        const Point solved = {dot(way, cross(rows[1], rows[2])) / determinant,
                              dot(rows[0], cross(way, rows[2])) / determinant,
                              dot(rows[0], cross(rows[1], way)) / determinant};
        std::vector<double> weights(points_.size());
        for (std::size_t i = 0; i < points_.size(); ++i)
            weights[i] = 1 / static_cast<double>(points_.size()) + dot(solved, minus(places_[points_[i]], mean_));
        return weights;
    }

    std::span<const std::uint64_t> points_;
    std::span<const OutwardTriangle> triangles_;
    const core::PointReader& places_;
    bool single_;
    Point mean_{};
};

} // namespace

Centre find_centre(std::span<const std::uint64_t> points, std::span<const OutwardTriangle> triangles,
                   const core::PointReader& places, bool single) {
    return CentreFinder(points, triangles, places, single).find();
}

} // namespace isotet::linear
