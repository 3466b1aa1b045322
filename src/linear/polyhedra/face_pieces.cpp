// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "linear/polyhedra/face_pieces.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "linear/vector.hpp"

namespace isotet::linear {

namespace {

constexpr std::size_t max_ear_points = 64; // ears cost the cube
constexpr double least_share = 1e-9;       // of the face's area, for a triangle with an area
constexpr double least_quality = 0.1;      // of a fan's triangle: twice its area over the square of its longest edge
// Hanging points lie on lines of the face but for rounding, of six digits in text. An ear that such a point touches would
// leave a triangle without an area. Shares of the face's area, the smaller ones where no ear is left by the larger.
constexpr std::array<double, 3> rim_shares = {1e-3, 1e-9, 0};

/// A face in the making: its points, and areas along its normal.
class FaceCutter {
public:
    FaceCutter(std::span<const std::uint64_t> loop, const core::PointReader& points) {
        const Point origin = points[loop[0]];
        places_.reserve(loop.size());
        for (const std::uint64_t point : loop) places_.push_back(minus(points[point], origin));
        for (std::size_t i = 0; i < places_.size(); ++i) { // Newell's normal
            const Point part = cross(places_[i], places_[(i + 1) % places_.size()]);
            for (std::size_t axis = 0; axis < 3; ++axis) normal_[axis] += part[axis];
        }
        least_ = least_share * dot(normal_, normal_);
        least_good_ = least_quality * std::sqrt(dot(normal_, normal_));
    }

    std::uint32_t size() const { return static_cast<std::uint32_t>(places_.size()); }

    /// A point nearly on the line of its neighbours, a hanging one say, makes a thin triangle of any direction.
    bool is_fan_good() const {
        for (std::uint32_t i = 1; i + 1 < size(); ++i)
            if (!is_good(0, i, i + 1)) return false;
        return true;
    }

    /// A good fan, two triangles at a time.
    void cut_fan(std::vector<LoopPiece>& out) const {
        for (std::uint32_t i = 1; i + 1 < size(); ++i) {
            if (i + 2 < size() && is_good(i, i + 1, i + 2) && is_good(0, i, i + 2)) {
                out.push_back({{0, i, i + 1, i + 2}, 4});
                ++i;
            } else {
                out.push_back({{0, i, i + 1, 0}, 3});
            }
        }
    }

    void cut_ears(std::vector<LoopPiece>& out) const {
        std::vector<std::uint32_t> left(size());
        std::iota(left.begin(), left.end(), 0U);
        while (left.size() > 3) {
            const std::size_t ear = best_ear(left);
            if (ear == left.size()) break;
            const std::size_t n = left.size();
            out.push_back({{left[(ear + n - 1) % n], left[ear], left[(ear + 1) % n], 0}, 3});
            left.erase(left.begin() + static_cast<std::ptrdiff_t>(ear));
        }
        for (std::size_t i = 1; i + 1 < left.size(); ++i) out.push_back({{left[0], left[i], left[i + 1], 0}, 3});
    }

    /// A quadrilateral with the diagonal that an ear, the best-shaped, has.
    LoopPiece turned() const {
        const std::uint32_t ear =
            static_cast<std::uint32_t>(best_ear({0, 1, 2, 3})) % 4; // without one the second point
        const std::uint32_t first = (ear + 3) % 4;
        return {{first, ear, (ear + 1) % 4, (ear + 2) % 4}, 4};
    }

private:
    /// Twice the area as seen along the normal, times the normal's length.
    double area(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
        return dot(cross(minus(places_[b], places_[a]), minus(places_[c], places_[a])), normal_);
    }

    bool is_good(std::uint32_t a, std::uint32_t b, std::uint32_t c) const { return quality(a, b, c) > least_good_; }

    /// Twice the area over the square of the longest edge, times the normal's length; 0 where there is hardly an area.
    double quality(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
        const double size = area(a, b, c);
        if (!(size > least_)) return 0;
        return size /
               std::max({core::squared_distance(places_[a], places_[b]), core::squared_distance(places_[b], places_[c]),
                         core::squared_distance(places_[c], places_[a])});
    }

    /// Inside, on the rim, or outside of it by so little that no side of the triangle gets more than `rim` with it.
    bool holds_a_point(const std::vector<std::uint32_t>& left, const std::array<std::uint32_t, 3>& ear,
                       double rim) const {
        const auto [a, b, c] = ear;
        return std::ranges::any_of(left, [&, a = a, b = b, c = c](std::uint32_t p) {
            return p != a && p != b && p != c && area(a, b, p) >= -rim && area(b, c, p) >= -rim &&
                   area(c, a, p) >= -rim;
        });
    }

    /// The position of the tip of the best-shaped ear; the number of points where there is none.
    std::size_t best_ear(const std::vector<std::uint32_t>& left) const {
        std::size_t best = left.size();
        for (std::size_t i = 0; best == left.size() && i < rim_shares.size(); ++i)
            best = best_ear(left, rim_shares[i] * dot(normal_, normal_));
        return best;
    }
    std::size_t best_ear(const std::vector<std::uint32_t>& left, double rim) const {
        const std::size_t n = left.size();
        std::size_t best = n;
        double best_quality = 0;
        for (std::size_t i = 0; i < n; ++i) {
            const std::uint32_t a = left[(i + n - 1) % n], b = left[i], c = left[(i + 1) % n];
            const double shape = quality(a, b, c);
            if (shape > best_quality && !holds_a_point(left, {a, b, c}, rim)) {
                best = i;
                best_quality = shape;
            }
        }
        return best;
    }

    std::vector<Point> places_; ///< from the first one
    Point normal_{};
    double least_ = 0, least_good_ = 0;
};

} // namespace

void cut_face(std::span<const std::uint64_t> loop, const core::PointReader& points, std::vector<LoopPiece>& out) {
    const auto n = static_cast<std::uint32_t>(loop.size());
    if (n == 3 || n > max_ear_points) {
        for (std::uint32_t i = 1; i + 1 < n; ++i) out.push_back({{0, i, i + 1, 0}, 3});
        return;
    }
    const FaceCutter cutter(loop, points);
    const bool fan = cutter.is_fan_good();
    if (n == 4) out.push_back(fan ? LoopPiece{{0, 1, 2, 3}, 4} : cutter.turned());
    else if (fan) cutter.cut_fan(out);
    else cutter.cut_ears(out);
}

} // namespace isotet::linear
