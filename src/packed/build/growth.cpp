// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "packed/build/growth.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <utility>

#include "packed/build/point_numbers.hpp"

namespace isotet::core {

namespace {

/// Points that would complete a tet, and how much each is wanted. Looking for the best one is what growth does most:
/// the scores stand side by side in 16 bits, in loops without exits that compilers turn into SIMD, eight at a time and
/// more.
class Candidates {
public:
    std::uint32_t add(std::uint32_t point, std::int16_t score) {
        const std::size_t at = points_.size();
        points_.push_back(point);
        if (at == scores_.size()) scores_.resize(at + piece, 0);
        scores_[at] = score;
        return static_cast<std::uint32_t>(at);
    }
    /// Scores end at the highest that there is, which only points of over 107 tets reach.
    void raise(std::uint32_t at, std::int16_t by) {
        scores_[at] = static_cast<std::int16_t>(std::min(scores_[at] + by, 0x7fff));
    }

    /// Puts the last candidate where the dropped one was, and returns it.
    std::uint32_t drop(std::uint32_t at) {
        const std::uint32_t last = points_.back();
        points_[at] = last;
        scores_[at] = scores_[points_.size() - 1];
        scores_[points_.size() - 1] = 0;
        points_.pop_back();
        return last;
    }

    /// The first of those with the highest score, or no_number.
    std::uint32_t best() const {
        std::int16_t highest = 0;
        const std::size_t n =
            (points_.size() + piece - 1) / piece * piece; // behind the last candidate all scores are 0
        for (std::size_t i = 0; i < n; ++i) highest = std::max(highest, scores_[i]);
        if (highest == 0) return no_number;
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

/// Sorts different numbers below cells_per_block.
class TetSorter {
public:
    void add(std::uint32_t tet) {
        words_[tet / 64] |= std::uint64_t{1} << tet % 64;
        full_words_[tet / 4096] |= std::uint64_t{1} << tet / 64 % 64;
    }

    /// Calls f for each number, ascending, and forgets it.
    template <class F>
    void drain(const F& f) {
        for (std::size_t i = 0; i < full_words_.size(); ++i)
            for (; full_words_[i]; full_words_[i] &= full_words_[i] - 1) {
                const std::size_t word = 64 * i + static_cast<std::size_t>(std::countr_zero(full_words_[i]));
                for (; words_[word]; words_[word] &= words_[word] - 1)
                    f(static_cast<std::uint32_t>(64 * word + static_cast<std::size_t>(std::countr_zero(words_[word]))));
            }
    }

private:
    std::array<std::uint64_t, cells_per_block / 64> words_{};
    std::array<std::uint64_t, cells_per_block / 4096> full_words_{}; ///< which words are not 0
};

/// How far a tet is from completion, in one word that a joining corner changes without looking at the others: how many
/// of its corners are in the growing cluster, and the exclusive or of the numbers of those that are not. So when three
/// are in, the word says which one is missing.
class TetState {
public:
    static TetState none_inside(const RankedTet& corners) {
        return TetState(corners[0] ^ corners[1] ^ corners[2] ^ corners[3]);
    }
    static TetState taken() { return TetState(taken_word); }

    TetState with(std::uint32_t corner) const { return TetState((word_ ^ corner) + one_inside); }
    TetState without(std::uint32_t corner) const { return TetState((word_ - one_inside) ^ corner); }
    std::uint32_t inside() const { return word_ / one_inside; }
    std::uint32_t missing() const { return word_ % one_inside; }
    bool is_taken() const { return word_ == taken_word; }

private:
    static constexpr std::uint32_t one_inside = 1u << 24, taken_word = ~0u;
    static_assert(4 * cells_per_block <= one_inside, "all corners may be different points");

    explicit TetState(std::uint32_t word) : word_(word) {}

    std::uint32_t word_;
};

class Grower {
public:
    explicit Grower(Buffer<RankedTet> tets)
        : numbers_(tets.empty() ? 0 : lowest_rank(tets[0])),
          corners_(std::move(tets)),
          states_(corners_.size()),
          tets_of_(4 * corners_.size()) {
        for (RankedTet& tet : corners_)
            for (std::uint32_t& corner : tet) corner = numbers_.number(corner);
        vertices_.resize(numbers_.points().size());
        places_.resize(vertices_.size(), outside);
        for (std::size_t i = 0; i < corners_.size(); ++i) {
            states_[i] = TetState::none_inside(corners_[i]);
            for (const std::uint32_t v : corners_[i]) ++vertices_[v].left;
        }
        std::uint32_t first = 0;
        for (Vertex& vertex : vertices_) {
            vertex.first = first;
            first += vertex.left;
        }
        for (std::size_t i = 0; i < corners_.size(); ++i)
            for (const std::uint32_t v : corners_[i])
                tets_of_[vertices_[v].first + vertices_[v].listed++] = static_cast<std::uint16_t>(i);
        for (std::size_t k = 1; k < weight_.size(); ++k)
            weight_[k] = static_cast<std::int16_t>(score_one + 20 * score_one / k);
    }

    BlockClusters run() {
        BlockClusters out;
        out.order = Buffer<std::uint32_t>(corners_.size());
        out.words = Buffer<StoredTet>(corners_.size());
        out.points.reserve(corners_.size() / 2);
        for (std::size_t first = 0; first < corners_.size();) {
            grow_one();
            first += finish_cluster(out, first);
        }
        return out;
    }

private:
    struct Vertex {
        std::uint32_t first = 0, listed = 0; ///< its tets: `listed` from tets_of_[first] on
        std::uint32_t left = 0; ///< of these, in no cluster; behind by those of taken_ that are not settled
        std::uint32_t candidate = no_number; ///< position among the candidates, or no_number
    };

    void grow_one() {
        start(last_points_);
        while (points_.size() < max_cluster_points && !full_) {
            const std::uint32_t best = candidates_.best();
            if (best != no_number) {
                drop_candidate(vertices_[best]);
                join(best);
                continue;
            }
            settle();
            if (!start(points_)) break; // nothing left beside the cluster: go on with the next tet along the curve
        }
    }

    /// Adds the points of a tet that is left: one beside the given points, else the next along the curve. False when
    /// there is no_number, or no room for it.
    bool start(const std::vector<std::uint32_t>& points) {
        std::uint32_t seed = beside(points);
        if (seed == no_number) {
            while (next_ < corners_.size() && states_[next_].is_taken()) ++next_;
            if (next_ == corners_.size()) return false;
            seed = static_cast<std::uint32_t>(next_);
        }
        const RankedTet corners = corners_[seed];
        std::size_t missing = 0;
        for (const std::uint32_t v : corners) missing += places_[v] == outside;
        if (points_.size() + missing > max_cluster_points) return false;
        for (const std::uint32_t v : corners) {
            if (places_[v] != outside || full_) continue;
            if (vertices_[v].candidate != no_number) drop_candidate(vertices_[v]);
            join(v);
        }
        return true;
    }

    /// A tet of the point with the fewest tets left among `points`; of its tets, the one along the curve first.
    std::uint32_t beside(const std::vector<std::uint32_t>& points) {
        std::uint32_t best = no_number;
        for (const std::uint32_t v : points)
            if (vertices_[v].left && (best == no_number || vertices_[v].left < vertices_[best].left)) best = v;
        if (best == no_number) return no_number;
        std::uint32_t seed = no_number;
        for_tets_left(vertices_[best], [&](std::uint32_t tet) { seed = std::min(seed, tet); });
        return seed;
    }

    /// What joins has no taken tets in its list: these have all their points in the clusters of which they are, and
    /// every cluster cleans the lists of its points in the end.
    void join(std::uint32_t v) {
        places_[v] = inside;
        points_.push_back(v);
        const std::uint16_t* const list = tets_of_.data() + vertices_[v].first;
        const std::uint32_t listed = vertices_[v].listed;
        // Branch-free pass first: whether a tet comes far enough is unpredictable.
        constexpr std::uint32_t some = 64;
        std::array<std::uint32_t, some> wanted, complete;
        for (std::uint32_t begin = 0; begin < listed; begin += some) {
            std::size_t wanted_count = 0, complete_count = 0;
            for (std::uint32_t i = begin; i < std::min(listed, begin + some); ++i) {
                const std::uint32_t tet = list[i];
                const TetState state = states_[tet].with(v);
                states_[tet] = state;
                wanted[wanted_count] = state.missing();
                wanted_count += state.inside() == 3;
                complete[complete_count] = tet;
                complete_count += state.inside() == 4;
            }
            for (std::size_t i = 0; i < wanted_count; ++i) add_gain(wanted[i]);
            for (std::size_t i = 0; i < complete_count && !full_; ++i) take(complete[i]);
        }
    }

    void take(std::uint32_t tet) {
        if (taken_.size() == max_cluster_tets) {
            full_ = true;
            return;
        }
        states_[tet] = TetState::taken();
        taken_.push_back(tet);
    }

    /// One more tet that v would complete. The score is gain * (1 + 20 / left), in 1/256, and `left` stays what it is
    /// while v is a candidate: all points of a tet that is taken are in the cluster.
    void add_gain(std::uint32_t v) {
        Vertex& vertex = vertices_[v];
        const std::int16_t weight = weight_[std::min<std::size_t>(vertex.left, weight_.size() - 1)];
        if (vertex.candidate == no_number) vertex.candidate = candidates_.add(v, weight);
        else candidates_.raise(vertex.candidate, weight);
    }
    void drop_candidate(Vertex& vertex) {
        const std::uint32_t moved = candidates_.drop(vertex.candidate);
        vertices_[moved].candidate = vertex.candidate;
        vertex.candidate = no_number;
    }

    /// Brings `left` of the points inside up to date, which is seldom wanted before the cluster is finished.
    void settle() {
        for (; settled_ < taken_.size(); ++settled_)
            for (const std::uint32_t v : corners_[taken_[settled_]]) --vertices_[v].left;
    }

    /// `first`: where the cluster's tets go; returns how many they are.
    std::size_t finish_cluster(BlockClusters& out, std::size_t first) {
        const std::span<std::uint32_t> tets(out.order.data() + first, taken_.size());
        std::size_t next = 0;
        for (const std::uint32_t tet : taken_) sorter_.add(tet);
        sorter_.drain(
            [&](std::uint32_t tet) { tets[next++] = tet; }); // along the curve: tets of a group are close together

        // A point that joined for a tet which was not taken any more is not in the cluster: places go to those that
        // tets use.
        if (full_) {
            for (const std::uint32_t v : points_) places_[v] = outside;
            for (const std::uint32_t tet : tets)
                for (const std::uint32_t v : corners_[tet]) places_[v] = inside;
        }
        std::uint8_t place = 0;
        for (const std::uint32_t v : points_)
            if (places_[v] == inside) {
                places_[v] = place++;
                out.points.push_back(numbers_.points()[v]);
            }
        for (std::size_t i = 0; i < tets.size(); ++i)
            for (std::size_t k = 0; k < 4; ++k) out.words[first + i].corners[k] = places_[corners_[tets[i]][k]];
        out.clusters.push_back({{static_cast<std::uint16_t>(tets.size())}, place});

        // Forget what only this cluster knew. Tets that were begun but not taken start from nothing again.
        for (const std::uint32_t v : points_) {
            places_[v] = outside;
            for_tets_left(vertices_[v], [&](std::uint32_t tet) { states_[tet] = states_[tet].without(v); });
            vertices_[v].left = vertices_[v].listed;
        }
        for (const std::uint32_t v : candidates_.points()) vertices_[v].candidate = no_number;
        candidates_.clear();
        taken_.clear();
        settled_ = 0;
        last_points_.swap(points_);
        points_.clear();
        full_ = false;
        return tets.size();
    }

    /// Calls f for every tet of the vertex that is in no cluster yet, and drops the others from its list for good.
    template <class F>
    void for_tets_left(Vertex& vertex, F&& f) {
        std::uint16_t* const list = tets_of_.data() + vertex.first;
        for (std::uint32_t i = 0; i < vertex.listed;) {
            const std::uint32_t tet = list[i];
            if (states_[tet].is_taken()) {
                list[i] = list[--vertex.listed];
                continue;
            }
            f(tet);
            ++i;
        }
    }

    static constexpr std::size_t score_one = 256;
    static constexpr std::uint8_t outside = 255, inside = 254; ///< beside the places from 0 on
    static_assert(max_cluster_points <= inside);

    PointNumbers numbers_;
    Buffer<RankedTet> corners_; ///< by the points' numbers in this block
    Buffer<TetState> states_;   ///< of each tet
    std::vector<Vertex> vertices_;
    std::vector<std::uint8_t> places_; ///< of each vertex: whether it is in the growing cluster, in the end also where
    Buffer<std::uint16_t> tets_of_;
    Candidates candidates_;
    std::vector<std::uint32_t> taken_; ///< tets of the growing cluster
    std::size_t settled_ = 0;          ///< of these
    TetSorter sorter_;
    std::vector<std::uint32_t> points_, last_points_;
    std::array<std::int16_t, 256> weight_{};
    std::size_t next_ = 0;
    bool full_ = false;
};
static_assert(cells_per_block <= 65536, "tets of points are numbers of 16 bits");

} // namespace

BlockClusters grow_clusters(Buffer<RankedTet> tets) { return Grower(std::move(tets)).run(); }

} // namespace isotet::core
