// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/pieces/join/joined_cells.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "base/buffer.hpp"
#include "base/system/memory.hpp"
#include "base/parallel.hpp"
#include "io/pieces/join/face_streams.hpp"
#include "io/pieces/join/piece_points.hpp"

namespace isotet::io {
namespace {

constexpr std::uint64_t block = std::uint64_t{1} << 15; ///< cells that a thread takes at once

struct Counts {
    std::uint64_t cells = 0, corners = 0;
};

/// Kept cells and their corners before each block, and of all.
std::vector<Counts> counts_before(const PieceCells& cells, const std::vector<std::uint8_t>& left_out) {
    std::vector<Counts> counts((cells.count() + block - 1) / block + 1);
    core::parallel_each(counts.size() - 1, 1, [&](std::size_t b) {
        const std::uint64_t begin = b * block, end = std::min<std::uint64_t>(begin + block, cells.count());
        Counts& here = counts[b + 1];
        if (left_out.empty()) {
            here = {end - begin, cells.begin(end) - cells.begin(begin)};
            return;
        }
        for (std::uint64_t cell = begin; cell < end; ++cell)
            if (left_out[cell] == 0) {
                ++here.cells;
                here.corners += cells.begin(cell + 1) - cells.begin(cell);
            }
    });
    for (std::size_t b = 1; b < counts.size(); ++b) {
        counts[b].cells += counts[b - 1].cells;
        counts[b].corners += counts[b - 1].corners;
    }
    return counts;
}

/// What of the cells' description the joined grid needs.
struct Shape {
    Counts all;
    bool uniform = true; ///< all kept cells are of one linear type
    CellType type = CellType::tetrahedron;
    bool has_faces = false;
};

template <class Index>
class Joiner {
public:
    Joiner(std::vector<Piece>& pieces, const PointNumbers& numbers, const Shape& shape)
        : pieces_(pieces),
          numbers_(numbers),
          shape_(shape),
          connectivity_(shape.all.corners),
          offsets_(shape.uniform ? 0 : shape.all.cells + 1),
          types_(shape.uniform ? 0 : shape.all.cells) {
        if (!shape.uniform) offsets_[0] = 0;
    }

    /// `first`   kept cells and corners of the pieces before
    void add(std::size_t p, Counts first) {
        const Piece& piece = pieces_[p];
        const PieceCells cells(piece.grid.cells);
        const std::vector<Counts> before = counts_before(cells, piece.left_out);
        core::parallel_each(before.size() - 1, 1, [&](std::size_t b) {
            const std::uint64_t begin = b * block, end = std::min<std::uint64_t>(begin + block, cells.count());
            const Counts to{first.cells + before[b].cells, first.corners + before[b].corners};
            if (shape_.uniform && piece.left_out.empty())
                copy(p, cells, cells.begin(begin), cells.begin(end), to.corners);
            else add_block(p, cells, begin, end, to);
        });
        if (shape_.has_faces)
            faces_.add(piece.grid.cells, piece.left_out,
                       [&](std::uint64_t point) { return numbers_.pieces[p](point); });
    }

    Cells cells() && {
        Cells cells;
        cells.uniform_type = shape_.uniform ? shape_.type : CellType::tetrahedron;
        cells.connectivity = std::move(connectivity_).to_array();
        if (!shape_.uniform) {
            cells.offsets = std::move(offsets_).to_array();
            cells.types = std::move(types_).to_array();
        }
        std::move(faces_).give_to(cells);
        return cells;
    }

private:
    /// Corners [begin, end) of a piece to `to` on.
    void copy(std::size_t p, const PieceCells& cells, std::uint64_t begin, std::uint64_t end, std::uint64_t to) {
        const PieceNumbers& numbers = numbers_.pieces[p];
        cells.connectivity().visit([&](const auto* corners) {
            for (std::uint64_t i = begin; i < end; ++i)
                connectivity_[to++] = static_cast<Index>(numbers(core::widened(corners[i])));
        });
    }

    void add_block(std::size_t p, const PieceCells& cells, std::uint64_t begin, std::uint64_t end, Counts to) {
        const std::vector<std::uint8_t>& left_out = pieces_[p].left_out;
        for (std::uint64_t cell = begin; cell < end; ++cell) {
            if (!left_out.empty() && left_out[cell] != 0) continue;
            const std::uint64_t first = cells.begin(cell), last = cells.begin(cell + 1);
            copy(p, cells, first, last, to.corners);
            to.corners += last - first;
            if (!shape_.uniform) {
                types_[to.cells] = cells.type(cell);
                offsets_[to.cells + 1] = static_cast<Index>(to.corners);
            }
            ++to.cells;
        }
    }

    std::vector<Piece>& pieces_;
    const PointNumbers& numbers_;
    const Shape& shape_;
    core::Buffer<Index> connectivity_, offsets_;
    core::Buffer<std::uint8_t> types_;
    FaceStreams faces_;
};

Shape shape_of(const std::vector<Piece>& pieces, const std::vector<Counts>& counts) {
    Shape shape;
    for (std::size_t p = 0; p < pieces.size(); ++p) {
        const Cells& cells = pieces[p].grid.cells;
        shape.has_faces = shape.has_faces || !cells.faces.empty();
        if (counts[p].cells == 0) continue;
        if (shape.all.cells == 0) shape.type = cells.uniform_type;
        shape.uniform = shape.uniform && cells.types.empty() && cells.uniform_type == shape.type;
        shape.all.cells += counts[p].cells;
        shape.all.corners += counts[p].corners;
    }
    return shape;
}

template <class Index>
Result<JoinedCells> join_as(std::vector<Piece>& pieces, std::span<const std::size_t> order, const PointNumbers& numbers,
                            const std::vector<Counts>& counts, const Shape& shape, const Progress& progress) {
    Joiner<Index> joiner(pieces, numbers, shape);
    JoinedCells result;
    result.first.resize(pieces.size());
    for (const Counts& of_piece : counts) result.kept.push_back(of_piece.cells);
    Counts first;
    for (const std::size_t p : order) {
        if (progress.cancelled()) return Error{ErrorCode::cancelled, "joining pieces was cancelled"};
        result.first[p] = first.cells;
        joiner.add(p, first);
        pieces[p].grid.cells = Cells();
        first.cells += counts[p].cells;
        first.corners += counts[p].corners;
        progress("join pieces",
                 0.4 + 0.3 * static_cast<double>(first.cells) / static_cast<double>(shape.all.cells + 1));
    }
    result.count = first.cells;
    result.cells = std::move(joiner).cells();
    return result;
}

} // namespace

Result<JoinedCells> join_cells(std::vector<Piece>& pieces, std::span<const std::size_t> order,
                               const PointNumbers& numbers, const Progress& progress) {
    std::vector<Counts> counts(pieces.size());
    std::uint64_t largest = 0;
    for (std::size_t p = 0; p < pieces.size(); ++p) {
        counts[p] = counts_before(PieceCells(pieces[p].grid.cells), pieces[p].left_out).back();
        largest = std::max<std::uint64_t>(largest, pieces[p].grid.cells.connectivity.bytes());
    }
    const Shape shape = shape_of(pieces, counts);
    constexpr auto max_narrow = static_cast<std::uint64_t>(std::numeric_limits<std::int32_t>::max());
    const bool narrow = std::max(numbers.count, shape.uniform ? 0 : shape.all.corners) <= max_narrow;
    // The cells of a piece are freed before the next one's are copied.
    if (auto enough = core::require_memory("joining the cells of pieces", 2 * largest); !enough) return enough.error();
    return narrow ? join_as<std::int32_t>(pieces, order, numbers, counts, shape, progress)
                  : join_as<std::int64_t>(pieces, order, numbers, counts, shape, progress);
}

void each_kept_block(const std::vector<std::uint8_t>& left_out, std::uint64_t count,
                     const std::function<void(std::uint64_t, std::uint64_t, std::uint64_t)>& visit) {
    std::vector<std::uint64_t> before((count + block - 1) / block + 1);
    core::parallel_each(before.size() - 1, 1, [&](std::size_t b) {
        const std::uint64_t begin = b * block, end = std::min<std::uint64_t>(begin + block, count);
        before[b + 1] = end - begin;
        for (std::uint64_t cell = begin; !left_out.empty() && cell < end; ++cell) before[b + 1] -= left_out[cell] != 0;
    });
    for (std::size_t b = 1; b < before.size(); ++b) before[b] += before[b - 1];
    core::parallel_each(before.size() - 1, 1, [&](std::size_t b) {
        const std::uint64_t begin = b * block;
        visit(begin, std::min<std::uint64_t>(begin + block, count), before[b]);
    });
}

} // namespace isotet::io
