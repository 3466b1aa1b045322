// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The faces of a cell of any kind as loops of points.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "grid/cell_faces.hpp"
#include "grid/cells.hpp"

namespace isotet::linear {

/// One after another, in one memory. A cell's loops are in the order of its kind or of the file; points that repeat the
/// one before are dropped, and loops of fewer than three points.
class CellLoops {
public:
    CellLoops(const core::CellReader& cells, const core::FaceReader& faces) : cells_(cells), faces_(faces) {}

    /// Of a checked cell. False: it has no volume that is contoured.
    bool read(std::size_t cell) {
        points_.clear();
        ends_.clear();
        if (core::is_contoured(cells_.type(cell))) read_whole(cells_.whole(cell));
        else if (!core::is_polyhedron(cells_, faces_, cell)) return false;
        else if (const std::uint64_t sides = core::prism_sides(cells_.type(cell))) read_prism(cell, sides);
        else read_listed(cell);
        return true;
    }

    std::size_t count() const { return ends_.size(); }
    std::span<const std::uint64_t> loop(std::size_t face) const {
        const std::size_t begin = face ? ends_[face - 1] : 0;
        return {points_.data() + begin, ends_[face] - begin};
    }
    std::span<const std::uint64_t> all() const { return points_; }

private:
    void add(std::size_t count, const auto& point_at) {
        const std::size_t begin = ends_.empty() ? 0 : ends_.back();
        for (std::size_t i = 0; i < count; ++i)
            if (const std::uint64_t point = point_at(i); points_.size() == begin || points_.back() != point)
                points_.push_back(point);
        while (points_.size() > begin + 1 && points_.back() == points_[begin]) points_.pop_back();
        if (points_.size() < begin + 3) points_.resize(begin);
        else ends_.push_back(points_.size());
    }
    void read_whole(const core::WholeCell& cell) {
        for (const core::CellFace& face : core::shape_of(cell.kind).faces())
            add(face.count, [&](std::size_t i) { return cell.corners[face.corners[i]]; });
    }
    void read_prism(std::size_t cell, std::uint64_t sides) {
        const std::uint64_t bottom = cells_.first(cell), top = bottom + sides;
        for (const std::uint64_t end : {bottom, top})
            add(sides, [&](std::size_t i) { return cells_.corner(end + i); });
        for (std::uint64_t side = 0; side < sides; ++side) {
            const std::uint64_t next = (side + 1) % sides;
            const std::uint64_t corners[] = {bottom + side, bottom + next, top + next, top + side};
            add(4, [&](std::size_t i) { return cells_.corner(corners[i]); });
        }
    }
    void read_listed(std::size_t cell) {
        std::uint64_t at = faces_.begin(cell);
        for (std::uint64_t face = faces_.at(at++); face > 0; --face) {
            const std::uint64_t points = faces_.at(at++);
            add(points, [&](std::size_t i) { return faces_.at(at + i); });
            at += points;
        }
    }

    const core::CellReader& cells_;
    const core::FaceReader& faces_;
    std::vector<std::uint64_t> points_;
    std::vector<std::size_t> ends_;
};

} // namespace isotet::linear
