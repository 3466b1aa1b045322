// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "core/growth.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <utility>

namespace isotet::core {

namespace {

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

/// Numbers the points of a block 0, 1, 2, ... in the order in which they are first seen. The tets of a block come by their
/// lowest rank, so most of its points are within a short stretch of ranks, and have their numbers in a table; a hash table
/// has those of the others.
class PointNumbers {
public:
    explicit PointNumbers(std::uint32_t lowest) : lowest_(lowest), near_(1 << 16) {
        std::fill(near_.begin(), near_.end(), none);
        rehash(1 << 12);
    }

    std::uint32_t number(std::uint32_t point) {
        if (const std::uint32_t at = point - lowest_; at < near_.size()) {
            if (near_[at] == none) near_[at] = add(point);
            return near_[at];
        }
        std::size_t slot = hash(point);
        for (; slots_[slot].number != none; slot = (slot + 1) & mask_)
            if (slots_[slot].point == point) return slots_[slot].number;
        slots_[slot] = {point, add(point)};
        const std::uint32_t number = slots_[slot].number;
        if (2 * ++far_ > slots_.size()) rehash(2 * slots_.size());
        return number;
    }
    const std::vector<std::uint32_t>& points() const { return points_; }

private:
    struct Slot {
        std::uint32_t point, number;
    };

    std::uint32_t add(std::uint32_t point) {
        points_.push_back(point);
        return static_cast<std::uint32_t>(points_.size() - 1);
    }
    std::size_t hash(std::uint32_t point) const { return (point * 0x9e3779b97f4a7c15u >> 32) & mask_; }
    void rehash(std::size_t size) {
        const std::vector<Slot> old = std::exchange(slots_, std::vector<Slot>(size, {0, none}));
        mask_ = size - 1;
        for (const Slot& taken : old) {
            if (taken.number == none) continue;
            std::size_t slot = hash(taken.point);
            while (slots_[slot].number != none) slot = (slot + 1) & mask_;
            slots_[slot] = taken;
        }
    }

    std::uint32_t lowest_;
    Buffer<std::uint32_t> near_; ///< by rank from the lowest on: the number, or none
    std::vector<Slot> slots_;
    std::vector<std::uint32_t> points_;
    std::size_t mask_ = 0, far_ = 0;
};

/// Points that would complete a tet, and how much each is wanted. Looking for the best one is what growth does most: the
/// scores stand side by side in 16 bits, in loops without exits that compilers turn into SIMD, eight at a time and more.
class Candidates {
public:
    std::uint32_t add(std::uint32_t point) {
        const std::size_t at = points_.size();
        points_.push_back(point);
        if (at == scores_.size()) scores_.resize(at + piece, 0);
        return static_cast<std::uint32_t>(at);
    }
    void set_score(std::uint32_t at, std::int16_t score) { scores_[at] = score; }

    /// Puts the last candidate where the dropped one was, and returns it.
    std::uint32_t drop(std::uint32_t at) {
        const std::uint32_t last = points_.back();
        points_[at] = last;
        scores_[at] = scores_[points_.size() - 1];
        scores_[points_.size() - 1] = 0;
        points_.pop_back();
        return last;
    }

    /// The first of those with the highest score, or none.
    std::uint32_t best() const {
        std::int16_t highest = 0;
        const std::size_t n = (points_.size() + piece - 1) / piece * piece; // behind the last candidate all scores are 0
        for (std::size_t i = 0; i < n; ++i) highest = std::max(highest, scores_[i]);
        if (highest == 0) return none;
        std::size_t begin = 0;
        while (!holds(begin, highest)) begin += piece;
        while (scores_[begin] != highest) ++begin;
        return points_[begin];
    }

    const std::vector<std::uint32_t>& points() const { return points_; }
    void clear() {
        std::fill_n(scores_.begin(), points_.size(), std::int16_t{0});
        points_.clear();
    }

private:
    static constexpr std::size_t piece = 32;

    bool holds(std::size_t begin, std::int16_t score) const {
        std::int16_t found = 0;
        for (std::size_t i = begin; i < begin + piece; ++i) found |= static_cast<std::int16_t>(-(scores_[i] == score));
        return found != 0;
    }

    std::vector<std::uint32_t> points_;
    std::vector<std::int16_t> scores_;
};

/// A set of numbers below tets_a_block that is read in ascending order.
class TetSet {
public:
    void add(std::uint32_t tet) {
        words_[tet / 64] |= std::uint64_t{1} << tet % 64;
        full_words_[tet / 4096] |= std::uint64_t{1} << tet / 64 % 64;
        ++size_;
    }
    std::size_t size() const { return size_; }

    /// Calls f for each number and forgets it.
    template <class F>
    void drain(const F& f) {
        for (std::size_t i = 0; i < full_words_.size(); ++i)
            for (; full_words_[i]; full_words_[i] &= full_words_[i] - 1) {
                const std::size_t word = 64 * i + static_cast<std::size_t>(std::countr_zero(full_words_[i]));
                for (; words_[word]; words_[word] &= words_[word] - 1)
                    f(static_cast<std::uint32_t>(64 * word + static_cast<std::size_t>(std::countr_zero(words_[word]))));
            }
        size_ = 0;
    }

private:
    std::array<std::uint64_t, tets_a_block / 64> words_{};
    std::array<std::uint64_t, tets_a_block / 4096> full_words_{}; ///< which words are not 0
    std::size_t size_ = 0;
};

std::uint32_t lowest_rank(std::span<const RankedTet> tets) {
    return tets.empty() ? 0 : *std::min_element(tets[0].begin(), tets[0].end());
}

class Grower {
public:
    explicit Grower(std::span<const RankedTet> tets) : numbers_(lowest_rank(tets)), corners_(tets.size()), inside_(tets.size(), 0) {
        for (std::size_t i = 0; i < tets.size(); ++i)
            for (std::size_t k = 0; k < 4; ++k) corners_[i][k] = numbers_.number(tets[i][k]);
        vertices_.resize(numbers_.points().size());
        for (const auto& tet : corners_)
            for (const std::uint32_t v : tet) ++vertices_[v].left;
        std::uint32_t first = 0;
        for (Vertex& vertex : vertices_) {
            vertex.first = first;
            first += vertex.left;
        }
        tets_of_ = Buffer<std::uint32_t>(4 * tets.size());
        for (std::uint32_t i = 0; i < corners_.size(); ++i)
            for (const std::uint32_t v : corners_[i]) tets_of_[vertices_[v].first + vertices_[v].listed++] = i;
        for (std::size_t k = 1; k < weight_.size(); ++k) weight_[k] = static_cast<std::uint32_t>(score_one + 20 * score_one / k);
    }

    BlockClusters run() {
        BlockClusters out;
        out.order = Buffer<std::uint32_t>(corners_.size());
        out.tets = Buffer<StoredTet>(corners_.size());
        out.points.reserve(corners_.size() / 2);
        for (std::size_t first = 0; first < corners_.size();) {
            grow_one();
            first += finish_cluster(out, first);
        }
        return out;
    }

private:
    struct Vertex {
        std::uint32_t first = 0, listed = 0;           ///< its tets: `listed` from tets_of_[first] on
        std::uint32_t left = 0;                        ///< tets that are in no cluster
        std::uint32_t gain = 0;                        ///< tets that it would complete
        std::uint32_t place = none;                    ///< in the growing cluster, or none
        std::uint32_t candidate = none;                ///< position among the candidates, or none
    };

    void grow_one() {
        start();
        while (points_.size() < max_cluster_points && !full_) {
            const std::uint32_t best = candidates_.best();
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
        for (const std::uint32_t v : corners_[seed]) missing += vertices_[v].place == none;
        if (points_.size() + missing > max_cluster_points) return false;
        for (const std::uint32_t v : corners_[seed])
            if (vertices_[v].place == none && !full_) join(v);
        return true;
    }

    /// A tet of the point with the fewest tets left among `points`; of its tets, the one along the curve first.
    std::uint32_t beside(const std::vector<std::uint32_t>& points) {
        std::uint32_t best = none;
        for (const std::uint32_t v : points)
            if (vertices_[v].left && (best == none || vertices_[v].left < vertices_[best].left)) best = v;
        if (best == none) return none;
        std::uint32_t seed = none;
        for_tets_left(vertices_[best], [&](std::uint32_t tet) { seed = std::min(seed, tet); });
        return seed;
    }

    /// gain * (1 + 20 / left), in 1/256. Since gain is at most left, it is cut off only for points of over 107 tets.
    void update_score(const Vertex& vertex) {
        if (vertex.candidate == none) return;
        const std::uint32_t score = vertex.gain * weight_[std::min<std::size_t>(vertex.left, weight_.size() - 1)];
        candidates_.set_score(vertex.candidate, static_cast<std::int16_t>(std::min<std::uint32_t>(score, 0x7fff)));
    }

    void join(std::uint32_t v) {
        Vertex& joining = vertices_[v];
        joining.place = static_cast<std::uint32_t>(points_.size());
        points_.push_back(v);
        if (joining.candidate != none) drop_candidate(joining);
        for_tets_left(joining, [&](std::uint32_t tet) {
            if (++inside_[tet] == 3) {
                for (const std::uint32_t w : corners_[tet])
                    if (vertices_[w].place == none) add_gain(w);
            } else if (inside_[tet] == 4) {
                if (tets_.size() < max_cluster_tets) take(tet);
                else full_ = true;
            }
        });
    }

    void take(std::uint32_t tet) {
        inside_[tet] = taken;
        tets_.add(tet);
        for (const std::uint32_t v : corners_[tet]) {
            --vertices_[v].left;
            update_score(vertices_[v]);
        }
    }

    void add_gain(std::uint32_t v) {
        Vertex& vertex = vertices_[v];
        if (vertex.gain++ == 0) vertex.candidate = candidates_.add(v);
        update_score(vertex);
    }
    void drop_candidate(Vertex& vertex) {
        const std::uint32_t moved = candidates_.drop(vertex.candidate);
        vertices_[moved].candidate = vertex.candidate;
        vertex.candidate = none;
        vertex.gain = 0;
    }

    /// `first`: where the cluster's tets go; returns how many they are.
    std::size_t finish_cluster(BlockClusters& out, std::size_t first) {
        const std::span<std::uint32_t> tets(out.order.data() + first, tets_.size());
        std::size_t next = 0;
        tets_.drain([&](std::uint32_t tet) { tets[next++] = tet; }); // along the curve: tets of a group are close together

        // A point that joined for a tet which was not completed is not in the cluster: places go to those that tets use.
        for (const std::uint32_t v : points_) vertices_[v].place = none;
        for (const std::uint32_t tet : tets)
            for (const std::uint32_t v : corners_[tet]) vertices_[v].place = 0;
        std::uint32_t place = 0;
        for (const std::uint32_t v : points_)
            if (vertices_[v].place == 0) {
                vertices_[v].place = place++;
                out.points.push_back(numbers_.points()[v]);
            }
        for (std::size_t i = 0; i < tets.size(); ++i)
            for (std::size_t k = 0; k < 4; ++k)
                out.tets[first + i].corners[k] = static_cast<std::uint8_t>(vertices_[corners_[tets[i]][k]].place);
        out.clusters.push_back({static_cast<std::uint32_t>(tets.size()), place});

        // Forget what only this cluster knew. Tets that were begun but not completed start from nothing again.
        for (const std::uint32_t v : points_) {
            vertices_[v].place = none;
            for_tets_left(vertices_[v], [&](std::uint32_t tet) { inside_[tet] = 0; });
        }
        for (const std::uint32_t v : candidates_.points()) {
            vertices_[v].gain = 0;
            vertices_[v].candidate = none;
        }
        candidates_.clear();
        last_points_.swap(points_);
        points_.clear();
        full_ = false;
        return tets.size();
    }

    /// Calls f for every tet of the vertex that is in no cluster yet, and drops the others from its list for good.
    template <class F>
    void for_tets_left(Vertex& vertex, F&& f) {
        std::uint32_t* const list = tets_of_.data() + vertex.first;
        for (std::uint32_t i = 0; i < vertex.listed;) {
            const std::uint32_t tet = list[i];
            if (done(tet)) {
                list[i] = list[--vertex.listed];
                continue;
            }
            f(tet);
            ++i;
        }
    }

    bool done(std::size_t tet) const { return inside_[tet] == taken; }

    static constexpr std::uint8_t taken = 255;
    static constexpr std::size_t score_one = 256;

    PointNumbers numbers_;
    Buffer<RankedTet> corners_;
    std::vector<std::uint8_t> inside_;     ///< corners of each tet that are in the growing cluster; or taken
    std::vector<Vertex> vertices_;
    Buffer<std::uint32_t> tets_of_;
    Candidates candidates_;
    TetSet tets_;                          ///< of the growing cluster
    std::vector<std::uint32_t> points_, last_points_;
    std::array<std::uint32_t, 256> weight_{};
    std::size_t next_ = 0;
    bool full_ = false;
};

} // namespace

BlockClusters grow_clusters(std::span<const RankedTet> tets) { return Grower(tets).run(); }

} // namespace isotet::core
