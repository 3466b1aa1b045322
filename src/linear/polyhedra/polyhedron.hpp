// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// One polyhedron as linear cells.
#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "linear/parts.hpp"
#include "linear/polyhedra/centre.hpp"
#include "linear/polyhedra/face_pieces.hpp"
#include "linear/polyhedra/shell.hpp"

namespace isotet::linear {

/// Point numbers of a triangle or a quadrilateral, counter-clockwise seen from outside.
struct OutwardPiece {
    std::array<std::uint64_t, 4> corners;
    std::uint32_t count;
};

/// A piece by its corners around, the lowest first, then the lower of the two beside it; a triangle ends with its third
/// once more.
struct PieceKey {
    std::array<std::uint64_t, 4> around;
    std::uint32_t piece;
    bool forward; ///< whether the piece has them in this direction

    friend auto operator<=>(const PieceKey&, const PieceKey&) = default;
};

/// What faces of more than four points are cut into. Where cells are refined, a quadrilateral is bilinear, and the tets on
/// a large one would be bent by that.
enum class LargeFaces : std::uint8_t { quadrilaterals, triangles };

/// Splits polyhedra, one after another, and keeps its memory between them. Borrows all it is given.
class PolyhedronSplitter {
public:
    PolyhedronSplitter(const Grid& grid, const core::CellReader& cells, const core::FaceReader& faces,
                       const LinearizeOptions& options, LargeFaces large = LargeFaces::quadrilaterals)
        : cells_(cells),
          faces_(faces),
          options_(options),
          large_(large),
          points_(grid.points),
          single_(grid.points.type() == ScalarType::float32) {}

    /// Adds what the cell becomes; an open one becomes a cell of type 0.
    void split(std::size_t cell, Parts& out);

    /// Six times the volume; -1 of an open one.
    double six_volumes(std::size_t cell);

private:
    std::optional<core::WholeCell> find_known_shape(std::size_t cell);
    bool keep_known_shape(std::size_t cell, Parts& out);
    void cut_faces();
    void cancel_pieces();
    bool keeps_order(const OutwardPiece& piece, const Centre& centre) const;
    void split_around_centre(std::size_t cell, Parts& out);

    const core::CellReader& cells_;
    const core::FaceReader& faces_;
    const LinearizeOptions& options_;
    LargeFaces large_;
    core::PointReader points_;
    bool single_;
    Shell shell_;
    std::vector<LoopPiece> loop_pieces_; ///< of one face
    std::vector<OutwardPiece> pieces_;   ///< of all faces
    std::vector<PieceKey> keys_;         ///< of these
    std::vector<OutwardTriangle> triangles_;
    std::vector<std::uint64_t> listed_;
};

} // namespace isotet::linear
