// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The faces of one polyhedron, put in order: the same for any order and winding in the file.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "grid/cell_faces.hpp"
#include "grid/orientation.hpp"

namespace isotet::linear {

/// A loop is in canonical form when its lowest point comes first and the lower neighbour of that second. The loops of a
/// shell are sorted. One shell serves many cells, one after another, to keep its memory.
class Shell {
public:
    /// Reads the faces of a polyhedron or prism, which check_cells() and check_faces() have passed. Points that repeat the
    /// one before are dropped, and faces of fewer than three points with them.
    ///
    /// Returns   false when the cell is open: an edge that is not in two faces, a face that meets itself, or faces that are
    ///           not connected or cannot all be turned outward
    bool read(const core::CellReader& cells, const core::FaceReader& faces, std::size_t cell,
              const core::PointReader& points);

    std::size_t face_count() const { return ends_.size(); }
    std::span<const std::uint64_t> loop(std::size_t face) const {
        const std::size_t begin = face ? ends_[face - 1] : 0;
        return {loops_.data() + begin, ends_[face] - begin};
    }
    /// True when the loop is clockwise seen from outside.
    bool is_inward(std::size_t face) const { return inward_[face]; }
    /// The points of all faces, each once, ascending.
    const std::vector<std::uint64_t>& points() const { return points_; }
    /// Each edge twice, in two faces that follow each other: lower point first.
    struct Edge {
        std::uint64_t low, high;
        std::uint32_t face;
        bool forward; ///< from the lower point to the higher one, in the loop
    };
    const std::vector<Edge>& edges() const { return edges_; }
    /// Enclosed by the faces, each a fan from the first point of its loop.
    double six_volumes(const core::PointReader& points) const;

private:
    void read_listed(const core::FaceReader& faces, std::size_t cell);
    void read_prism(const core::CellReader& cells, std::size_t cell, std::uint64_t sides);
    void add_loop(std::uint64_t count, const auto& point_at);
    void sort_loops();
    bool find_edges();
    bool wind();

    std::vector<std::uint64_t> loops_, points_, unsorted_;
    std::vector<std::size_t> ends_, unsorted_ends_;
    std::vector<std::uint32_t> order_;
    std::vector<Edge> edges_;
    std::vector<std::uint8_t> inward_, wound_;
    std::vector<std::uint32_t> first_neighbour_, queue_;
    struct Neighbour {
        std::uint32_t face, other;
        bool same_direction;
    };
    std::vector<Neighbour> neighbours_;
};

} // namespace isotet::linear
