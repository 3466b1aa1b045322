// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "core/growth.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>

namespace isotet::core {

namespace {

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

/// Numbers the points of a block 0, 1, 2, ... in the order in which they are first seen.
class PointNumbers {
public:
    PointNumbers() { rehash(1 << 15); }

    std::uint32_t number(std::uint64_t point) {
        std::size_t slot = hash(point);
        while (slots_[slot] != none) {
            if (points_[slots_[slot]] == point) return slots_[slot];
            slot = (slot + 1) & mask_;
        }
        const auto number = static_cast<std::uint32_t>(points_.size());
        slots_[slot] = number;
        points_.push_back(point);
        if (2 * points_.size() > slots_.size()) rehash(2 * slots_.size());
        return number;
    }
    const std::vector<std::uint64_t>& points() const { return points_; }

private:
    std::size_t hash(std::uint64_t point) const { return (point * 0x9e3779b97f4a7c15u >> 32) & mask_; }
    void rehash(std::size_t size) {
        slots_.assign(size, none);
        mask_ = size - 1;
        for (std::uint32_t i = 0; i < points_.size(); ++i) {
            std::size_t slot = hash(points_[i]);
            while (slots_[slot] != none) slot = (slot + 1) & mask_;
            slots_[slot] = i;
        }
    }

    std::vector<std::uint32_t> slots_;
    std::vector<std::uint64_t> points_;
    std::size_t mask_ = 0;
};

class Grower {
public:
    explicit Grower(std::span<const Tet> tets) : corners_(tets.size()), inside_(tets.size(), 0) {
        for (std::size_t i = 0; i < tets.size(); ++i)
            for (std::size_t k = 0; k < 4; ++k) corners_[i][k] = numbers_.number(tets[i][k]);
        const std::size_t n = numbers_.points().size();
        left_.assign(n, 0);
        gain_.assign(n, 0);
        place_.assign(n, none);
        candidate_.assign(n, none);
        for (const auto& tet : corners_)
            for (const std::uint32_t v : tet) ++left_[v];
        listed_ = left_;
        first_.assign(n + 1, 0);
        for (std::size_t v = 0; v < n; ++v) first_[v + 1] = first_[v] + left_[v];
        tets_of_.resize(4 * tets.size());
        auto next = first_;
        for (std::uint32_t i = 0; i < corners_.size(); ++i)
            for (const std::uint32_t v : corners_[i]) tets_of_[next[v]++] = i;
        for (std::size_t k = 0; k < weight_.size(); ++k) weight_[k] = k ? 1.0f + 20.0f / static_cast<float>(k) : 0.0f;
    }

    BlockClusters run() {
        BlockClusters out;
        out.order.reserve(corners_.size());
        out.tets.reserve(corners_.size());
        while (out.order.size() < corners_.size()) {
            grow_one();
            finish_cluster(out);
        }
        return out;
    }

private:
    void grow_one() {
        start();
        while (points_.size() < max_cluster_points && !full_) {
            const std::uint32_t best = best_candidate();
            if (best != none) join(best);
            else if (!start()) break; // nothing left beside the cluster: go on with the next tet along the curve
        }
    }

    /// Adds the points of a tet that is left: beside the points of this cluster, else of the last one, else the next
    /// along the curve. False when there is none, or no room for it.
    bool start() {
        std::uint32_t seed = beside(points_.empty() ? last_points_ : points_);
        if (seed == none) {
            while (next_ < corners_.size() && done(next_)) ++next_;
            if (next_ == corners_.size()) return false;
            seed = static_cast<std::uint32_t>(next_);
        }
        std::size_t missing = 0;
        for (const std::uint32_t v : corners_[seed]) missing += place_[v] == none;
        if (points_.size() + missing > max_cluster_points) return false;
        for (const std::uint32_t v : corners_[seed])
            if (place_[v] == none && !full_) join(v);
        return true;
    }

    /// A tet of the point with the fewest tets left among `points`; of its tets, the one along the curve first.
    std::uint32_t beside(const std::vector<std::uint32_t>& points) {
        std::uint32_t best = none;
        for (const std::uint32_t v : points)
            if (left_[v] && (best == none || left_[v] < left_[best])) best = v;
        if (best == none) return none;
        std::uint32_t seed = none;
        for_tets_left(best, [&](std::uint32_t tet) { seed = std::min(seed, tet); });
        return seed;
    }

    /// The candidate with the largest score; of equal ones the lowest. Two plain loops, which compilers turn into SIMD.
    std::uint32_t best_candidate() const {
        std::int32_t best_score = 0;
        for (const std::int32_t score : scores_) best_score = std::max(best_score, score);
        std::uint32_t best = none;
        for (std::size_t i = 0; i < candidates_.size(); ++i)
            best = std::min(best, scores_[i] == best_score ? candidates_[i] : none);
        return best;
    }

    void update_score(std::uint32_t v) {
        if (candidate_[v] == none) return;
        const float score = static_cast<float>(gain_[v]) * weight_[std::min<std::size_t>(left_[v], weight_.size() - 1)];
        scores_[candidate_[v]] = std::bit_cast<std::int32_t>(score);
    }

    void join(std::uint32_t v) {
        place_[v] = static_cast<std::uint32_t>(points_.size());
        points_.push_back(v);
        if (candidate_[v] != none) drop_candidate(v);
        for_tets_left(v, [&](std::uint32_t tet) {
            if (++inside_[tet] == 3) {
                for (const std::uint32_t w : corners_[tet])
                    if (place_[w] == none) add_gain(w);
            } else if (inside_[tet] == 4) {
                if (tets_.size() < max_cluster_tets) take(tet);
                else full_ = true;
            }
        });
    }

    void take(std::uint32_t tet) {
        inside_[tet] = taken;
        tets_.push_back(tet);
        for (const std::uint32_t v : corners_[tet]) {
            --left_[v];
            update_score(v);
        }
    }

    void add_gain(std::uint32_t v) {
        if (gain_[v]++ == 0) {
            candidate_[v] = static_cast<std::uint32_t>(candidates_.size());
            candidates_.push_back(v);
            scores_.push_back(0);
        }
        update_score(v);
    }
    void drop_candidate(std::uint32_t v) {
        const std::uint32_t last = candidates_.back();
        candidates_[candidate_[v]] = last;
        scores_[candidate_[v]] = scores_.back();
        candidate_[last] = candidate_[v];
        candidates_.pop_back();
        scores_.pop_back();
        candidate_[v] = none;
        gain_[v] = 0;
    }

    void finish_cluster(BlockClusters& out) {
        std::sort(tets_.begin(), tets_.end()); // along the curve: tets of a group are close together
        compact_points();
        for (const std::uint32_t tet : tets_) {
            StoredTet stored;
            for (std::size_t k = 0; k < 4; ++k) stored.corners[k] = static_cast<std::uint8_t>(place_[corners_[tet][k]]);
            out.tets.push_back(stored);
            out.order.push_back(tet);
        }
        const std::size_t before = out.points.size();
        for (const std::uint32_t v : points_)
            if (place_[v] != none) out.points.push_back(numbers_.points()[v]);
        out.clusters.push_back({static_cast<std::uint32_t>(tets_.size()), static_cast<std::uint32_t>(out.points.size() - before)});

        // Forget what only this cluster knew. Tets that were begun but not completed start from nothing again.
        for (const std::uint32_t v : points_) {
            place_[v] = none;
            for_tets_left(v, [&](std::uint32_t tet) { inside_[tet] = 0; });
        }
        for (const std::uint32_t v : candidates_) {
            gain_[v] = 0;
            candidate_[v] = none;
        }
        candidates_.clear();
        scores_.clear();
        last_points_.swap(points_);
        points_.clear();
        tets_.clear();
        full_ = false;
    }

    /// Gives places 0, 1, 2, ... to the points that the cluster's tets use, and none to the others (a point that joined
    /// for a tet which was not completed).
    void compact_points() {
        for (const std::uint32_t v : points_) place_[v] = none - 1;
        for (const std::uint32_t tet : tets_)
            for (const std::uint32_t v : corners_[tet]) place_[v] = 0;
        std::uint32_t place = 0;
        for (const std::uint32_t v : points_) place_[v] = place_[v] == 0 ? place++ : none;
    }

    /// Calls f for every tet of v that is in no cluster yet, and drops the others from v's list for good.
    template <class F>
    void for_tets_left(std::uint32_t v, F&& f) {
        std::uint32_t* list = tets_of_.data() + first_[v];
        std::uint32_t& count = listed_[v];
        for (std::uint32_t i = 0; i < count;) {
            const std::uint32_t tet = list[i];
            if (done(tet)) {
                list[i] = list[--count];
                continue;
            }
            f(tet);
            ++i;
        }
    }

    bool done(std::size_t tet) const { return inside_[tet] == taken; }

    static constexpr std::uint8_t taken = 255;

    PointNumbers numbers_;
    std::vector<std::array<std::uint32_t, 4>> corners_;
    std::vector<std::uint8_t> inside_;      ///< corners of each tet that are in the growing cluster; or taken
    std::vector<std::uint32_t> left_;       ///< tets of each point that are in no cluster
    std::vector<std::uint32_t> gain_;       ///< tets that the point would complete
    std::vector<std::uint32_t> place_;      ///< in the growing cluster, or none
    std::vector<std::uint32_t> candidate_;  ///< position among the candidates, or none
    std::vector<std::uint32_t> first_, listed_, tets_of_; ///< tets of v: listed_[v] from first_[v] on
    std::vector<std::uint32_t> candidates_, points_, last_points_, tets_;
    std::vector<std::int32_t> scores_; ///< gain x weight of each candidate, by its bits: positive floats order like integers
    std::array<float, 256> weight_{};
    std::size_t next_ = 0;
    bool full_ = false;
};

} // namespace

BlockClusters grow_clusters(std::span<const Tet> tets) { return Grower(tets).run(); }

} // namespace isotet::core
