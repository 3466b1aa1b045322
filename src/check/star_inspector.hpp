// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What is found around one vertex: edges, fans, repeated triangles. An edge or a triangle is counted at its lowest
// vertex.
#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "check/mesh.hpp"

namespace isotet::checking {

/// An edge, and how often triangles use it from its lower to its higher vertex and back.
struct EdgeUse {
    std::uint64_t low = 0, high = 0, forward = 0, backward = 0;
};

/// A triangle on the corners of an earlier one.
struct Repeat {
    std::uint64_t triangle = 0, earlier = 0;
};

/// What was found around a range of vertices. Lists marked "few" hold the first `most` only.
struct Tally {
    std::uint64_t boundary_edges = 0, inconsistent_edges = 0, non_manifold_edges = 0;
    std::uint64_t duplicates = 0, double_sheets = 0, touching = 0, unused = 0;
    std::vector<EdgeUse> unequal_edges;     ///< boundary and inconsistent ones: all if asked for, else few
    std::vector<Repeat> duplicate_list;     ///< all if asked for, else few
    std::vector<EdgeUse> non_manifold_list; ///< few
    std::vector<Repeat> double_sheet_list;  ///< few
    std::vector<std::uint64_t> touching_list; ///< few
};

/// What one vertex adds to its component.
struct Share {
    std::int64_t euler = 0; ///< 1 - edges + triangles counted here
    bool proper = true;     ///< every edge is used once in each direction, and the triangles here are one fan
};

class StarInspector {
public:
    /// `most`       entries of the lists of few;  `keep_all`   the other lists are complete
    StarInspector(const Mesh& mesh, std::size_t most, bool keep_all) : mesh_(mesh), most_(most), keep_all_(keep_all) {}

    /// Adds what is around a vertex to `tally`; `star` holds its triangles, at least one, and is sorted.
    template <class Index>
    Share inspect(std::uint64_t vertex, std::span<Index> star, Tally& tally) {
        std::ranges::sort(star);
        spokes_.clear();
        wings_.clear();
        for (std::size_t i = 0; i < star.size(); ++i) {
            Corners c = mesh_.corners(star[i]);
            while (c[0] != vertex) std::rotate(c.begin(), c.begin() + 1, c.end());
            spokes_.push_back({c[1], i, true});
            spokes_.push_back({c[2], i, false});
            if (vertex < c[1] && vertex < c[2])
                wings_.push_back({std::min(c[1], c[2]), std::max(c[1], c[2]), c[1] < c[2], star[i]});
        }
        Share share{1 + static_cast<std::int64_t>(wings_.size()), true};
        inspect_edges(vertex, star.size(), tally, share);
        inspect_repeats(tally);
        return share;
    }

private:
    struct Spoke {
        std::uint64_t other;     ///< the edge's other vertex
        std::uint64_t in_star;   ///< the triangle, as a position in the star
        bool outward;            ///< the triangle runs from the vertex to the other
    };
    struct Wing {
        std::uint64_t low, high; ///< the triangle's other vertices
        bool rising;             ///< the triangle runs from low to high
        std::uint64_t triangle;
    };

    template <class T>
    void add_to_few(std::vector<T>& list, const T& entry) const {
        if (list.size() < most_) list.push_back(entry);
    }
    template <class T>
    void add(std::vector<T>& list, const T& entry) const {
        if (keep_all_ || list.size() < most_) list.push_back(entry);
    }

    std::uint64_t leader(std::uint64_t i) {
        while (leaders_[i] != i) i = leaders_[i] = leaders_[leaders_[i]];
        return i;
    }

    void inspect_edges(std::uint64_t vertex, std::size_t triangles, Tally& tally, Share& share);
    void inspect_repeats(Tally& tally);

    const Mesh& mesh_;
    std::size_t most_;
    bool keep_all_;
    std::vector<Spoke> spokes_;
    std::vector<Wing> wings_;
    std::vector<std::uint64_t> leaders_;
};

} // namespace isotet::checking
