// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Clusters of native cells.
#include <algorithm>
#include <array>
#include <span>
#include <utility>

#include "packed/build/growth.hpp"
#include "packed/build/point_numbers.hpp"

namespace isotet::core {

namespace {

/// Cells that have been touched, by how many of their points are outside: of each number the one that came first is
/// taken first. A cell that has moved on stays where it was, and is passed over.
class CellQueue {
public:
    void push(std::uint32_t cell, std::size_t missing) { lists_[missing].cells.push_back(cell); }

    /// The first of those with the fewest points outside, at most `most`, for which is_there(cell, missing); or
    /// no_number.
    template <class IsThere>
    std::uint32_t pop(std::size_t most, const IsThere& is_there) {
        for (std::size_t missing = 1; missing <= std::min(most, lists_.size() - 1); ++missing) {
            List& list = lists_[missing];
            while (list.first < list.cells.size()) {
                const std::uint32_t cell = list.cells[list.first++];
                if (is_there(cell, missing)) return cell;
            }
        }
        return no_number;
    }
    void clear() {
        for (List& list : lists_) {
            list.cells.clear();
            list.first = 0;
        }
    }

private:
    struct List {
        std::vector<std::uint32_t> cells;
        std::size_t first = 0;
    };
    std::array<List, 9> lists_; ///< by points outside
};

class CellGrower {
public:
    explicit CellGrower(Buffer<RankedCell> cells)
        : numbers_(cells.empty() ? 0 : lowest_rank(cells[0])), corners_(std::move(cells)), states_(corners_.size()) {
        for (std::size_t i = 0; i < corners_.size(); ++i) {
            std::array<std::uint32_t, 8>& corners = corners_[i].corners;
            const CellKind kind = corners_[i].kind();
            for (std::size_t k = 0; k < corner_count(kind); ++k) corners[k] = numbers_.number(corners[k]);
            states_[i] = {kind, 0};
        }
        vertices_.resize(numbers_.points().size());
        places_.resize(vertices_.size(), outside);
        std::uint32_t sum = 0;
        for (std::uint32_t i = 0; i < corners_.size(); ++i)
            for (const std::uint32_t v : corners(i)) {
                Vertex& vertex = vertices_[v];
                const bool repeats = vertex.first == i + 1; // as yet the last cell that was seen here
                has_repeats_ |= repeats;
                vertex.first = i + 1;
                vertex.listed += !repeats;
                states_[i].missing += !repeats;
                sum += !repeats;
            }
        cells_of_ = Buffer<std::uint16_t>(sum);
        std::uint32_t first = 0;
        for (Vertex& vertex : vertices_) {
            vertex.first = first;
            first += std::exchange(vertex.listed, 0);
        }
        for (std::size_t i = 0; i < corners_.size(); ++i)
            for_points(i, [&](std::uint32_t v) {
                cells_of_[vertices_[v].first + vertices_[v].listed++] = static_cast<std::uint16_t>(i);
            });
    }

    BlockClusters run() {
        BlockClusters out;
        std::size_t words = 0;
        for (const State& state : states_) words += words_of(state.kind);
        out.order = Buffer<std::uint32_t>(corners_.size());
        out.words = Buffer<StoredTet>(words);
        out.points.reserve(2 * vertices_.size());
        for (std::size_t cell = 0, word = 0; cell < corners_.size();) {
            grow_one();
            finish_cluster(out, cell, word);
        }
        return out;
    }

private:
    struct Vertex {
        std::uint32_t first = 0, listed = 0; ///< its cells, ascending: `listed` from cells_of_[first] on
    };
    struct State {
        CellKind kind;
        std::uint8_t missing; ///< points outside of the growing cluster; has_been_taken for a cell of a cluster
    };
    static constexpr std::uint8_t has_been_taken = 255;
    bool is_taken(std::size_t cell) const { return states_[cell].missing == has_been_taken; }

    std::span<const std::uint32_t> corners(std::size_t cell) const {
        return {corners_[cell].corners.data(), corner_count(states_[cell].kind)};
    }
    std::span<const std::uint16_t> cells_of(std::uint32_t v) const {
        return {cells_of_.data() + vertices_[v].first, vertices_[v].listed};
    }
    /// Calls f(point) for every point of a cell, once for one that is several corners.
    template <class F>
    void for_points(std::size_t cell, const F& f) const {
        const auto all = corners(cell);
        for (auto at = all.begin(); at != all.end(); ++at)
            if (!has_repeats_ || std::find(all.begin(), at, *at) == at) f(*at);
    }

    void grow_one() {
        if (!start(beside(last_points_))) start(next_along_curve());
        while (!full_) {
            const std::uint32_t next =
                queue_.pop(max_cluster_points - points_.size(),
                           [&](std::uint32_t cell, std::size_t missing) { return states_[cell].missing == missing; });
            if (next != no_number) join_cell(next);
            else if (touches_any() || !start(next_along_curve())) break;
        }
    }

    /// Whether some cell beside the cluster is left, for which there is no room then.
    bool touches_any() const {
        return std::ranges::any_of(points_, [&](std::uint32_t v) {
            return std::ranges::any_of(cells_of(v), [&](std::uint16_t cell) { return !is_taken(cell); });
        });
    }

    bool start(std::uint32_t cell) {
        if (cell == no_number || points_.size() + states_[cell].missing > max_cluster_points) return false;
        join_cell(cell);
        return true;
    }

    std::uint32_t next_along_curve() {
        while (next_ < corners_.size() && is_taken(next_)) ++next_;
        return next_ == corners_.size() ? no_number : static_cast<std::uint32_t>(next_);
    }

    /// The first cell along the curve of those of the point with the fewest cells left among `points`, of which none
    /// is taken.
    std::uint32_t beside(const std::vector<std::uint32_t>& points) const {
        std::uint32_t best = no_number;
        for (const std::uint32_t v : points)
            if (vertices_[v].listed && (best == no_number || vertices_[v].listed < vertices_[best].listed)) best = v;
        return best == no_number ? no_number : cells_of_[vertices_[best].first];
    }

    /// Drops taken cells from a point's list for good, and tells the others that the point is outside again.
    void leave(Vertex& vertex) {
        std::uint16_t* const list = cells_of_.data() + vertex.first;
        std::uint32_t kept = 0;
        for (std::uint32_t i = 0; i < vertex.listed; ++i) {
            const std::uint16_t cell = list[i];
            const bool left = !is_taken(cell); // which cannot be predicted: no branch
            list[kept] = cell;
            kept += left;
            states_[cell].missing += left;
        }
        vertex.listed = kept;
    }

    /// The points of a cell join. The cell is then complete, and taken.
    void join_cell(std::uint32_t cell) {
        for (const std::uint32_t v : corners(cell))
            if (places_[v] == outside && !full_) join(v);
    }
    void join(std::uint32_t v) {
        places_[v] = inside;
        points_.push_back(v);
        const Vertex& vertex = vertices_[v];
        for (std::uint32_t i = 0; i < vertex.listed; ++i) {
            const std::uint32_t cell = cells_of_[vertex.first + i];
            State& state = states_[cell];
            if (state.missing == has_been_taken) continue;
            if (--state.missing == 0) take(cell);
            else queue_.push(cell, state.missing);
        }
    }
    void take(std::uint32_t cell) {
        const std::size_t size = states_[cell].kind == CellKind::tetrahedron ? 1 : tets_for_a_cell;
        if (size_ + size > max_mixed_cluster_tets) {
            full_ = true;
            return;
        }
        size_ += size;
        states_[cell].missing = has_been_taken;
        taken_.push_back(static_cast<std::uint32_t>(states_[cell].kind) << 16 | cell);
    }

    /// `cell`, `word`   where the cluster's cells go; afterwards where the next one's do
    void finish_cluster(BlockClusters& out, std::size_t& cell, std::size_t& word) {
        std::ranges::sort(taken_); // by kind, then along the curve
        for (std::uint32_t& taken : taken_) taken &= 0xffff;
        // A point that joined for a cell which was not taken any more is not in the cluster.
        for (const std::uint32_t v : points_) places_[v] = outside;
        for (const std::uint32_t taken : taken_)
            for (const std::uint32_t v : corners(taken)) places_[v] = inside;
        std::uint8_t place = 0;
        for (const std::uint32_t v : points_)
            if (places_[v] == inside) {
                places_[v] = place++;
                out.points.push_back(numbers_.points()[v]);
            }
        BlockClusters::Cluster cluster;
        cluster.points = place;
        for (const std::uint32_t taken : taken_) {
            const auto all = corners(taken);
            const std::size_t words = words_of(states_[taken].kind);
            for (std::size_t k = 0; k < 4 * words; ++k)
                out.words[word + k / 4].corners[k % 4] = places_[all[k < all.size() ? k : 0]];
            word += words;
            out.order[cell++] = taken;
            ++cluster.cells[static_cast<std::size_t>(states_[taken].kind)];
        }
        out.clusters.push_back(cluster);

        // Forget what only this cluster knew: no cell that is left has a point inside.
        for (const std::uint32_t v : points_) {
            places_[v] = outside;
            leave(vertices_[v]);
        }
        queue_.clear();
        taken_.clear();
        size_ = 0;
        last_points_.swap(points_);
        points_.clear();
        full_ = false;
    }

    static constexpr std::uint8_t outside = 255, inside = 254; ///< beside the places from 0 on
    static_assert(max_cluster_points <= inside);

    PointNumbers numbers_;
    Buffer<RankedCell> corners_; ///< by the points' numbers in this block
    Buffer<State> states_;       ///< of each cell
    std::vector<Vertex> vertices_;
    std::vector<std::uint8_t> places_; ///< of each vertex: whether it is in the growing cluster, in the end also where
    Buffer<std::uint16_t> cells_of_;
    CellQueue queue_;
    std::vector<std::uint32_t> taken_; ///< cells of the growing cluster, before it is finished 2^16 * kind more
    std::size_t size_ = 0;             ///< of these, as tets count
    std::vector<std::uint32_t> points_, last_points_;
    std::size_t next_ = 0;
    bool full_ = false;
    bool has_repeats_ = false; ///< some cell has a point as several corners
};
static_assert(cells_per_block <= 65536, "cells of points are numbers of 16 bits");

} // namespace

BlockClusters grow_clusters(Buffer<RankedCell> cells) { return CellGrower(std::move(cells)).run(); }

} // namespace isotet::core
