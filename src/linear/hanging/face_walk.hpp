// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The faces of cells one after another, and hashes by which the same face of two cells is found.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "grid/cell/native_cells.hpp"
#include "grid/cell/with_kind.hpp"
#include "grid/cell_faces.hpp"
#include "grid/cells.hpp"
#include "linear/hanging/cell_loops.hpp"
#include "linear/hanging/open_faces.hpp"
#include "numbers/point_hash.hpp"

namespace isotet::linear {

/// Of a point's number, and of the sum of these over a face.
constexpr std::uint64_t scattered(std::uint64_t x) {
    return core::folded_product(x ^ 0xa0761d6478bd642fu, 0x9e3779b97f4a7c15u);
}

/// A face's lowest point, and a hash of all, whatever their order.
struct FaceHash {
    std::uint64_t lowest, hash;
};

inline FaceHash hash_of(std::span<const std::uint64_t> loop) {
    FaceHash out{std::numeric_limits<std::uint64_t>::max(), 0};
    for (const std::uint64_t point : loop) {
        out.lowest = std::min(out.lowest, point);
        out.hash += scattered(point);
    }
    out.hash = scattered(out.hash);
    return out;
}

inline FaceHash hash_of(const core::WholeCell& cell, const core::CellFace& face,
                 const std::array<std::uint64_t, 8>& of_corners) {
    FaceHash out{std::numeric_limits<std::uint64_t>::max(), 0};
    for (const std::uint8_t corner : face.all()) {
        out.lowest = std::min(out.lowest, cell.corners[corner]);
        out.hash += of_corners[corner];
    }
    out.hash = scattered(out.hash);
    return out;
}

/// The faces of cells one after another. Those of a cell with eight different corners or fewer need no list.
class FaceWalk {
public:
    FaceWalk(const core::CellReader& cells, const core::FaceReader& faces) : cells_(cells), loops_(cells, faces) {}

    /// Calls use(number, hash) for each face of a cell.
    template <class Use>
    void each_hash(std::size_t cell, const Use& use) {
        if (!open(cell)) return;
        if (!is_whole_) {
            for (std::size_t face = 0; face < loops_.count(); ++face) use(face, hash_of(loops_.loop(face)));
            return;
        }
        core::with_kind(whole_.kind, [&](auto kind) {
            constexpr core::CellShape shape = core::shape_of(kind);
            std::array<std::uint64_t, 8> hashes{};
            for (std::size_t i = 0; i < core::corner_count(kind); ++i) hashes[i] = scattered(whole_.corners[i]);
            for (std::size_t face = 0; face < shape.face_count; ++face)
                use(face, hash_of(whole_, shape.all_faces[face], hashes));
        });
    }

    /// The cell whose faces follow. False: it has no volume that is contoured.
    bool open(std::size_t cell) {
        cell_ = cell;
        is_whole_ = core::is_contoured(cells_.type(cell));
        if (is_whole_) {
            whole_ = cells_.whole(cell);
            is_whole_ = !core::has_repeated_corner(whole_);
        }
        return is_whole_ || loops_.read(cell);
    }
    /// The cell that is open, where it has eight different corners or fewer; else null.
    const core::WholeCell* whole() const { return is_whole_ ? &whole_ : nullptr; }
    /// Of the cell that is open.
    std::size_t face_count() const {
        return is_whole_ ? core::shape_of(whole_.kind).faces().size() : loops_.count();
    }

    std::span<const std::uint64_t> loop(const OpenFaces::Place& place) {
        if (place.cell != cell_) open(place.cell);
        if (!is_whole_) return loops_.loop(place.face);
        const core::CellFace& face = core::shape_of(whole_.kind).faces()[place.face];
        for (std::size_t i = 0; i < face.count; ++i) corners_[i] = whole_.corners[face.corners[i]];
        return {corners_.data(), face.count};
    }

private:
    const core::CellReader& cells_;
    CellLoops loops_;
    core::WholeCell whole_{};
    bool is_whole_ = false;
    std::uint64_t cell_ = std::numeric_limits<std::uint64_t>::max(); ///< that is open
    std::array<std::uint64_t, 4> corners_{};
};

} // namespace isotet::linear
