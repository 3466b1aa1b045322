// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "linear/weld.hpp"

#include <algorithm>
#include <compare>
#include <limits>
#include <utility>

#include <fmt/format.h>
#include <tbb/parallel_sort.h>

#include "base/buffer.hpp"
#include "base/parallel.hpp"

namespace isotet::linear {

namespace {

/// A point on an edge or a face by what all tets there know of it; `owner` is where one of them has it.
struct SharedPoint {
    std::uint64_t place; ///< weights of the corners, in their order
    std::array<Node, 3> corners;
    std::uint32_t owner;

    bool is_same(const SharedPoint& other) const { return place == other.place && corners == other.corners; }
    auto operator<=>(const SharedPoint& other) const {
        if (const auto order = corners <=> other.corners; order != 0) return order;
        if (const auto order = place <=> other.place; order != 0) return order;
        return owner <=> other.owner;
    }
};

/// What a point of a block is.
struct Kind {
    enum class Of : std::uint8_t { user, shared, inside } of = Of::inside;
    Node user = 0;
    SharedPoint shared{};
};

Kind kind_of_point(const QuadraticTet& tet, const Place& place, std::uint64_t points) {
    const auto steps = steps_of(place);
    Kind kind;
    std::array<std::size_t, 4> at{};
    std::size_t corners = 0;
    for (std::size_t i = 0; i < 4; ++i)
        if (steps[i] > 0) at[corners++] = i;
    if (corners == 1) return {Kind::Of::user, tet[at[0]], {}};
    if (corners == 4) return kind;
    if (corners == 2 && steps[at[0]] == steps[at[1]]) {
        const Node middle = tet[4u + tet_edge_of[at[0]][at[1]]];
        if (middle < points) return {Kind::Of::user, middle, {}};
    }
    kind.of = Kind::Of::shared;
    kind.shared.place = std::uint64_t{steps[at[0]]} << 32 | steps[at[1]];
    kind.shared.corners = {tet[at[0]], tet[at[1]], corners == 3 ? tet[at[2]] : mean_node};
    return kind;
}

/// Where a block's part of the arrays begins.
struct WeldPlace {
    std::uint64_t point = 0, tet = 0, parent = 0, shared = 0, inside = 0;
};

Error too_many_points(std::uint64_t count, std::uint64_t most) {
    return {ErrorCode::out_of_memory,
            fmt::format("refining makes {} points, but there may be at most {}: a larger tolerance makes fewer", count,
                        most)};
}

class Welder {
public:
    Welder(std::vector<Bisected>& blocks, QuadraticTets& tets, std::uint64_t points)
        : blocks_(blocks), tets_(tets), points_(points), places_(blocks.size() + 1) {}

    Result<LinearGrid> weld(const Progress& progress) {
        count();
        if (end().point > std::numeric_limits<std::uint32_t>::max())
            return too_many_points(end().point, std::numeric_limits<std::uint32_t>::max());
        number_shared();
        if (progress.cancelled()) return Error{ErrorCode::cancelled, "refining was cancelled"};
        const std::uint64_t all = points_ + shared_count_ + end().inside;
        if (all >= max_nodes) return too_many_points(all, max_nodes);
        LinearGrid out;
        write_points(out);
        if (progress.cancelled()) return Error{ErrorCode::cancelled, "refining was cancelled"};
        write_tets(out);
        return out;
    }

private:
    const WeldPlace& end() const { return places_.back(); }

    void count() {
        core::parallel_each(blocks_.size(), 4, [&](std::size_t b) {
            const Bisected& block = blocks_[b];
            WeldPlace& counts = places_[b + 1];
            counts = {block.places.size(), block.tets.size(), block.children.size(), 0, 0};
            for (std::size_t i = 0; i < block.places.size(); ++i) {
                const Kind kind = kind_of_point(tets_.tets[block.parents[i]], block.places[i], points_);
                counts.shared += kind.of == Kind::Of::shared;
                counts.inside += kind.of == Kind::Of::inside;
            }
        });
        for (std::size_t b = 0; b < blocks_.size(); ++b) {
            const WeldPlace &from = places_[b], counts = places_[b + 1];
            places_[b + 1] = {from.point + counts.point, from.tet + counts.tet, from.parent + counts.parent,
                              from.shared + counts.shared, from.inside + counts.inside};
        }
    }

    /// Sorts the points of edges and faces; equal ones get one number.
    void number_shared() {
        core::Buffer<SharedPoint> shared(end().shared);
        numbers_ = core::Buffer<std::uint32_t>(end().point);
        core::parallel_each(blocks_.size(), 4, [&](std::size_t b) {
            const Bisected& block = blocks_[b];
            std::uint64_t next = places_[b].shared, inside = places_[b].inside;
            for (std::size_t i = 0; i < block.places.size(); ++i) {
                Kind kind = kind_of_point(tets_.tets[block.parents[i]], block.places[i], points_);
                const auto owner = static_cast<std::uint32_t>(places_[b].point + i);
                if (kind.of == Kind::Of::user) numbers_[owner] = kind.user;
                else if (kind.of == Kind::Of::inside) numbers_[owner] = static_cast<std::uint32_t>(inside++);
                if (kind.of != Kind::Of::shared) continue;
                kind.shared.owner = owner;
                shared[next++] = kind.shared;
            }
        });
        tbb::parallel_sort(shared.begin(), shared.end());
        owners_.reserve(shared.size() / 2);
        for (std::size_t i = 0; i < shared.size(); ++i) {
            if (i == 0 || !shared[i].is_same(shared[i - 1])) owners_.push_back(shared[i].owner);
            numbers_[shared[i].owner] = static_cast<std::uint32_t>(points_ + owners_.size() - 1);
        }
        shared_count_ = owners_.size();
    }

    void write_points(LinearGrid& out) {
        const std::uint64_t count = shared_count_ + end().inside;
        core::Buffer<std::uint32_t> places(3 * count);
        core::Buffer<std::uint32_t> parents(count);
        core::parallel_each(blocks_.size(), 4, [&](std::size_t b) {
            const Bisected& block = blocks_[b];
            const auto write = [&](std::uint64_t to, std::size_t i) {
                std::ranges::copy(block.places[i], places.data() + 3 * to);
                parents[to] = block.parents[i];
            };
            const std::uint64_t from = places_[b].point;
            for (std::size_t i = 0; i < block.places.size(); ++i) {
                const Kind kind = kind_of_point(tets_.tets[block.parents[i]], block.places[i], points_);
                std::uint32_t& number = numbers_[from + i];
                if (kind.of == Kind::Of::shared) {
                    if (owners_[number - points_] == from + i) write(number - points_, i);
                } else if (kind.of == Kind::Of::inside) {
                    write(shared_count_ + number, i);
                    number = static_cast<std::uint32_t>(points_ + shared_count_ + number);
                }
            }
        });
        out.refined.places = std::move(places).to_array(3);
        out.refined.parents = std::move(parents).to_array();
    }

    void write_tets(LinearGrid& out) {
        core::Buffer<std::int32_t> connectivity(4 * end().tet);
        core::Buffer<std::uint64_t> sources(end().tet);
        core::Buffer<std::uint32_t> children(tets_.tets.size());
        core::parallel_each(blocks_.size(), 4, [&](std::size_t b) {
            const Bisected& block = blocks_[b];
            const std::uint32_t* const numbers = numbers_.data() + places_[b].point;
            std::int32_t* corner = connectivity.data() + 4 * places_[b].tet;
            for (const auto& tet : block.tets)
                for (const std::uint32_t point : tet) *corner++ = static_cast<std::int32_t>(numbers[point]);
            std::uint64_t* source = sources.data() + places_[b].tet;
            for (std::size_t i = 0; i < block.children.size(); ++i) {
                const std::uint64_t parent = places_[b].parent + i;
                children[parent] = block.children[i];
                source = std::fill_n(source, block.children[i], tets_.sources[parent]);
            }
            blocks_[b] = {};
        });
        out.grid.cells.connectivity = std::move(connectivity).to_array();
        out.source_cells = std::move(sources).to_array();
        const std::size_t count = tets_.tets.size();
        core::Buffer<Node> nodes(10 * count);
        core::parallel_each(count, 1 << 14,
                            [&](std::size_t i) { std::ranges::copy(tets_.tets[i], nodes.data() + 10 * i); });
        out.refined.children = std::move(children).to_array();
        out.refined.nodes = std::move(nodes).to_array(10);
        out.refined.hidden = tets_.hidden;
    }

    std::vector<Bisected>& blocks_;
    QuadraticTets& tets_;
    std::uint64_t points_;
    std::vector<WeldPlace> places_;
    core::Buffer<std::uint32_t> numbers_; ///< of the points of all blocks
    std::vector<std::uint32_t> owners_;   ///< of shared points
    std::uint64_t shared_count_ = 0;
};

} // namespace

Result<LinearGrid> welded(std::vector<Bisected>& blocks, QuadraticTets& tets, std::uint64_t points,
                          const Progress& progress) {
    return Welder(blocks, tets, points).weld(progress);
}

} // namespace isotet::linear
