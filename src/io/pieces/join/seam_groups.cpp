// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/pieces/join/seam_groups.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <utility>

#include "base/disjoint_sets.hpp"

namespace isotet::io {
namespace {

using Members = std::vector<std::uint32_t>; ///< numbers in the group, ascending

constexpr std::size_t max_pairs_of = 128; ///< points of a group of which all pairs are looked at

double squared(const std::array<double, 3>& a, const std::array<double, 3>& b) {
    const double x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2];
    return x * x + y * y + z * z;
}

class Settling {
public:
    Settling(SeamGroup& group, Seams& seams) : points_(group.points), seams_(seams), sets_(points_.size()) {}

    void settle(DecideBy by) {
        if (by == DecideBy::ids) join_by_id();
        else if (points_.size() <= max_pairs_of) join_by_places();
        else join_at_equal_places();
        report();
    }

private:
    std::uint32_t piece(std::uint32_t member) const { return points_[member].piece; }

    bool has_one_of_each_piece(const Members& members) const {
        for (std::size_t i = 1; i < members.size(); ++i)
            if (piece(members[i]) == piece(members[i - 1])) return false;
        return true;
    }
    void join(const Members& members) {
        for (const std::uint32_t member : members) sets_.unite(members[0], member);
    }

    /// Sorts by key and takes the members of each key, ascending.
    template <class Key, class Take>
    void each_of_key(const Key& key, const Take& take) {
        Members all(points_.size());
        std::iota(all.begin(), all.end(), 0U);
        std::ranges::sort(all, {}, [&](std::uint32_t i) { return std::pair(key(points_[i]), i); });
        for (std::size_t begin = 0, end = 0; begin < all.size(); begin = end) {
            while (end < all.size() && key(points_[all[end]]) == key(points_[all[begin]])) ++end;
            take(Members(all.begin() + static_cast<std::ptrdiff_t>(begin),
                         all.begin() + static_cast<std::ptrdiff_t>(end)));
        }
    }

    void join_by_id() {
        each_of_key([](const SeamPoint& point) { return point.id; },
                    [&](const Members& members) {
                        if (has_one_of_each_piece(members)) join(members);
                    });
    }

    void join_at_equal_places() {
        each_of_key(
            [](const SeamPoint& point) {
                return std::array{point.place[0] + 0.0, point.place[1] + 0.0, point.place[2] + 0.0}; // -0 becomes +0
            },
            [&](const Members& members) {
                if (has_one_of_each_piece(members)) join(members);
            });
    }

    void join_by_places() {
        core::DisjointSets<std::uint32_t> close(points_.size());
        for (std::uint32_t i = 0; i < points_.size(); ++i)
            for (std::uint32_t j = 0; j < i; ++j)
                if (squared(points_[i].scaled, points_[j].scaled) <= 1) close.unite(i, j);
        for (std::uint32_t root = 0; root < points_.size(); ++root) {
            if (close.root(root) != root) continue;
            Members members;
            for (std::uint32_t i = root; i < points_.size(); ++i)
                if (close.root(i) == root) members.push_back(i);
            if (has_one_of_each_piece(members)) join(members);
            else join_nearest(members);
        }
    }

    /// The nearest of [begin, end) to a member within the tolerance; nothing where two are as near.
    std::uint32_t nearest(std::uint32_t member, std::span<const std::uint32_t> others) const {
        double least = 1;
        std::uint32_t found = none;
        bool tied = false;
        for (const std::uint32_t other : others) {
            const double distance = squared(points_[member].scaled, points_[other].scaled);
            if (distance > least) continue;
            tied = found != none && distance == least;
            least = distance;
            found = other;
        }
        return tied ? none : found;
    }

    /// Joins points that are each other's nearest, unless that joins two of one piece over others.
    void join_nearest(const Members& members) {
        core::DisjointSets<std::uint32_t> pairs(points_.size());
        const auto of_piece = [&](std::uint32_t member) {
            return std::ranges::equal_range(members, piece(member), {}, [&](std::uint32_t i) { return piece(i); });
        };
        for (const std::uint32_t i : members)
            for (const std::uint32_t j : members) {
                if (j >= i || piece(i) == piece(j)) continue;
                if (nearest(i, of_piece(j)) == j && nearest(j, of_piece(i)) == i) pairs.unite(i, j);
            }
        for (const std::uint32_t root : members) {
            if (pairs.root(root) != root) continue;
            Members joined;
            for (const std::uint32_t i : members)
                if (pairs.root(i) == root) joined.push_back(i);
            if (has_one_of_each_piece(joined)) join(joined);
        }
    }

    void report() {
        const auto count = static_cast<std::uint32_t>(points_.size());
        bool all_one = true;
        for (std::uint32_t i = 0; i < count; ++i) {
            const std::uint32_t root = sets_.root(i);
            if (root != i) seams_.joined.push_back({points_[i].point, points_[root].point});
            all_one = all_one && root == 0;
        }
        if (!all_one && count <= max_pairs_of) report_apart();
    }

    /// Whether a member is one with a point of a piece.
    bool is_joined_with(std::uint32_t member, std::uint32_t other_piece) {
        for (std::uint32_t i = 0; i < points_.size(); ++i)
            if (piece(i) == other_piece && sets_.root(i) == sets_.root(member)) return true;
        return false;
    }

    void report_apart() {
        for (std::uint32_t i = 0; i < points_.size(); ++i) {
            double least = std::numeric_limits<double>::infinity();
            bool at_one_place = false;
            for (std::uint32_t j = 0; j < points_.size(); ++j) {
                if (piece(i) == piece(j) || is_joined_with(i, piece(j)) || is_joined_with(j, piece(i))) continue;
                least = std::min(least, squared(points_[i].place, points_[j].place));
                at_one_place = at_one_place || squared(points_[i].scaled, points_[j].scaled) <= 1;
            }
            if (std::isinf(least)) continue;
            ++(at_one_place ? seams_.apart : seams_.near);
            seams_.gap = std::max(seams_.gap, std::sqrt(least));
        }
    }

    static constexpr std::uint32_t none = ~std::uint32_t{0};
    const std::vector<SeamPoint>& points_;
    Seams& seams_;
    core::DisjointSets<std::uint32_t> sets_;
};

} // namespace

void settle_group(SeamGroup& group, DecideBy by, Seams& seams) { Settling(group, seams).settle(by); }

} // namespace isotet::io
