// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/pieces/join/repeated_cells.hpp"

#include <algorithm>
#include <set>
#include <span>
#include <utility>

#include <isotet/linear_cells.hpp>

#include "base/system/memory.hpp"
#include "base/parallel.hpp"
#include "base/radix_sort.hpp"
#include "grid/cell_faces.hpp"
#include "io/pieces/join/piece_points.hpp"
#include "numbers/point_hash.hpp"

namespace isotet::io {
namespace {

using core::Keyed;
using Corners = std::vector<std::uint64_t>;

constexpr std::size_t cells_at_once = std::size_t{1} << 14;

class Finder {
public:
    Finder(std::vector<Piece>& pieces, const PointNumbers& numbers, const Progress& progress)
        : pieces_(pieces), numbers_(numbers), progress_(progress) {
        for (const Piece& piece : pieces_) {
            cells_.emplace_back(piece.grid.cells);
            first_.push_back(first_.back() + piece.grid.cells.count());
        }
    }

    Result<RepeatedCells> find() {
        std::vector<Keyed> candidates = find_candidates();
        if (auto enough = core::require_memory("comparing cells of pieces", sizeof(Keyed) * candidates.size()); !enough)
            return enough.error();
        std::vector<Keyed> scratch(candidates.size());
        core::radix_sort(candidates, scratch);
        if (progress_.cancelled()) return Error{ErrorCode::cancelled, "joining pieces was cancelled"};
        RepeatedCells result;
        std::set<std::size_t> in;
        for (std::size_t begin = 0, end = 0; begin < candidates.size(); begin = end) {
            while (end < candidates.size() && candidates[end].key == candidates[begin].key) ++end;
            if (end - begin > 1) leave_out(std::span(candidates).subspan(begin, end - begin), result.left_out, in);
        }
        result.pieces.assign(in.begin(), in.end());
        return result;
    }

private:
    /// Kept cells all of whose points are shared, by a hash of these.
    std::vector<Keyed> find_candidates() {
        struct Chunk {
            std::size_t piece, begin, end;
            std::vector<Keyed> found = {};
        };
        std::vector<Chunk> chunks;
        for (std::size_t p = 0; p < pieces_.size(); ++p)
            for (std::size_t i = 0; numbers_.pieces[p].has_shared() && i < cells_[p].count(); i += cells_at_once)
                chunks.push_back({p, i, std::min(i + cells_at_once, cells_[p].count())});
        core::parallel_each(chunks.size(), 1, [&](std::size_t c) {
            if (progress_.cancelled()) return;
            Chunk& chunk = chunks[c];
            for (std::size_t cell = chunk.begin; cell < chunk.end; ++cell)
                if (may_be_repeated(chunk.piece, cell))
                    chunk.found.push_back({hash_of(corners(chunk.piece, cell)), first_[chunk.piece] + cell});
        });
        std::vector<Keyed> all;
        for (const Chunk& chunk : chunks) all.insert(all.end(), chunk.found.begin(), chunk.found.end());
        return all;
    }

    bool may_be_repeated(std::size_t p, std::size_t cell) const {
        const PieceCells& cells = cells_[p];
        if (!pieces_[p].left_out.empty() && pieces_[p].left_out[cell] != 0) return false;
        const std::uint64_t end = cells.begin(cell + 1);
        std::uint64_t i = cells.begin(cell);
        while (i < end && numbers_.pieces[p].is_shared(cells.corner(i))) ++i;
        return i == end;
    }

    /// Ascending, and the kind of cell.
    Corners corners(std::size_t p, std::size_t cell) const {
        Corners result;
        const std::uint64_t end = cells_[p].begin(cell + 1);
        for (std::uint64_t i = cells_[p].begin(cell); i < end; ++i)
            result.push_back(numbers_.pieces[p](cells_[p].corner(i)));
        std::ranges::sort(result);
        result.push_back(kind_for_repetition(cells_[p].type(cell)));
        return result;
    }

    static std::uint64_t hash_of(const Corners& corners) {
        std::uint64_t hash = corners.size();
        for (const std::uint64_t corner : corners)
            hash = core::folded_product(hash ^ 0xA0761D6478BD642FU, corner ^ 0xE7037ED1A0B428DBU);
        return hash;
    }

    std::size_t piece_of(std::uint64_t cell) const {
        return static_cast<std::size_t>(std::ranges::upper_bound(first_, cell) - first_.begin() - 1);
    }
    /// Of cells with one hash, ascending: those with the points of one of an earlier piece.
    void leave_out(std::span<const Keyed> same_hash, std::uint64_t& count, std::set<std::size_t>& in) {
        struct First {
            std::size_t piece;
            Corners corners;
        };
        std::vector<First> different; // nearly always one
        for (const Keyed& item : same_hash) {
            const std::size_t piece = piece_of(item.number), cell = item.number - first_[piece];
            Corners here = corners(piece, cell);
            const auto known = std::ranges::find(different, here, &First::corners);
            if (known == different.end()) {
                different.push_back({piece, std::move(here)});
            } else if (known->piece != piece) {
                pieces_[piece].left_out.resize(cells_[piece].count());
                pieces_[piece].left_out[cell] = 1;
                ++count;
                in.insert({known->piece, piece});
            }
        }
    }

    std::vector<Piece>& pieces_;
    const PointNumbers& numbers_;
    const Progress& progress_;
    std::vector<PieceCells> cells_;
    std::vector<std::uint64_t> first_{0};
};

} // namespace

std::uint64_t kind_for_repetition(std::uint8_t type) {
    return core::is_contoured(type) || is_curved(type) || core::is_polyhedral(type) ? 256 : type;
}

Result<RepeatedCells> leave_out_repeated(std::vector<Piece>& pieces, const PointNumbers& numbers,
                                         const Progress& progress) {
    return Finder(pieces, numbers, progress).find();
}

} // namespace isotet::io
