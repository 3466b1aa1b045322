// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "paper/search/octree.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>

#include "base/parallel.hpp"
#include "numbers/hilbert.hpp"

namespace isotet::search {

namespace {

constexpr std::uint32_t max_in_leaf = 32;
constexpr unsigned levels = 21;

std::array<float, 3> centroid(const core::TetTable& table, const std::array<std::uint32_t, 4>& tet) {
    std::array<float, 3> sum{};
    for (const std::uint32_t point : tet)
        for (std::size_t axis = 0; axis < 3; ++axis) sum[axis] += 0.25f * table.points[point][axis];
    return sum;
}

/// The cube around all points, in 2^21 steps.
class Cube {
public:
    explicit Cube(const core::TetTable& table) {
        lower_.fill(std::numeric_limits<float>::infinity());
        std::array<float, 3> upper;
        upper.fill(-std::numeric_limits<float>::infinity());
        for (const auto& point : table.points)
            for (std::size_t axis = 0; axis < 3; ++axis) {
                lower_[axis] = std::min(lower_[axis], point[axis]);
                upper[axis] = std::max(upper[axis], point[axis]);
            }
        double extent = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) extent = std::max(extent, double{upper[axis]} - lower_[axis]);
        scale_ = extent > 0 ? 0x1.fffffp20 / extent : 0;
    }
    std::uint64_t key(const std::array<float, 3>& place) const {
        const auto step = [&](std::size_t axis) {
            return static_cast<std::uint32_t>(
                std::clamp((double{place[axis]} - lower_[axis]) * scale_, 0.0, 0x1.fffffp20));
        };
        return core::hilbert_index(step(0), step(1), step(2));
    }

private:
    std::array<float, 3> lower_;
    double scale_;
};

} // namespace

Octree::Octree(const core::TetTable& table) : tets_(table.tets.size()) {
    if (tets_.empty()) return;
    {
        core::Buffer<core::Keyed> sorted(tets_.size()), scratch(tets_.size());
        const Cube cube(table);
        core::parallel_each(tets_.size(), 1 << 14,
                            [&](std::size_t tet) { sorted[tet] = {cube.key(centroid(table, table.tets[tet])), tet}; });
        core::radix_sort({sorted.data(), sorted.size()}, {scratch.data(), scratch.size()});
        scratch.release();
        core::parallel_each(tets_.size(), 1 << 16,
                            [&](std::size_t i) { tets_[i] = static_cast<std::uint32_t>(sorted[i].number); });
        divide({sorted.data(), sorted.size()});
    }
    core::parallel_each(nodes_.size(), 1 << 10, [&](std::size_t n) {
        if (nodes_[n].children) return;
        for (std::uint32_t i = nodes_[n].begin; i < nodes_[n].end; ++i) nodes_[n].range.take_in(table.range(tets_[i]));
    });
    for (std::size_t n = nodes_.size(); n-- > 0;)
        for (std::uint32_t k = 0; k < nodes_[n].children; ++k)
            nodes_[n].range.take_in(nodes_[nodes_[n].first_child + k].range);
}

/// Makes the nodes over tets sorted by their keys, of which each three bits choose an octant.
void Octree::divide(std::span<const core::Keyed> sorted) {
    nodes_.push_back({{}, 0, static_cast<std::uint32_t>(sorted.size())});
    for (std::size_t n = 0; n < nodes_.size(); ++n) {
        const std::uint32_t begin = nodes_[n].begin, end = nodes_[n].end;
        const std::uint64_t differing =
            sorted[begin].key ^ sorted[end - 1].key; // sorted: nothing between differs higher up
        if (end - begin <= max_in_leaf || differing == 0) continue;
        const unsigned shift = static_cast<unsigned>(std::bit_width(differing) - 1) / 3 * 3;
        const auto first_child = static_cast<std::uint32_t>(nodes_.size());
        for (std::uint32_t from = begin; from < end;) {
            const std::uint64_t octant = sorted[from].key >> shift;
            const auto past = std::partition_point(sorted.begin() + from, sorted.begin() + end,
                                                   [&](const core::Keyed& tet) { return tet.key >> shift == octant; });
            const auto to = static_cast<std::uint32_t>(past - sorted.begin());
            nodes_.push_back({{}, from, to});
            from = to;
        }
        nodes_[n].first_child = first_child;
        nodes_[n].children = static_cast<std::uint32_t>(nodes_.size()) - first_child;
    }
}

void Octree::find(float isovalue, TetNumbers& found) const {
    found.clear();
    if (nodes_.empty() || !nodes_[0].range.holds(isovalue)) return;
    std::vector<std::uint32_t> open{0};
    while (!open.empty()) {
        const Node& node = nodes_[open.back()];
        open.pop_back();
        if (node.children == 0) {
            found.insert(found.end(), tets_.begin() + node.begin, tets_.begin() + node.end);
            continue;
        }
        for (std::uint32_t child = node.first_child + node.children; child-- > node.first_child;)
            if (nodes_[child].range.holds(isovalue)) open.push_back(child);
    }
}

} // namespace isotet::search
