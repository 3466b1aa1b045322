// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/pieces/join.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>
#include <string>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "io/files/escape.hpp"
#include "io/pieces/joined_cells.hpp"
#include "io/pieces/joined_fields.hpp"
#include "io/pieces/piece_points.hpp"
#include "io/pieces/point_numbers.hpp"
#include "io/pieces/repeated_cells.hpp"
#include "io/pieces/seams.hpp"
#include "io/pieces/uniform_cells.hpp"

namespace isotet::io {
namespace {

/// -1, 0, 1 by bytes, the shorter first.
int compare_bytes(const Array& a, const Array& b) {
    if (a.bytes() != b.bytes()) return a.bytes() < b.bytes() ? -1 : 1;
    return a.bytes() == 0 ? 0 : std::memcmp(a.data(), b.data(), a.bytes());
}

int compare_fields(const std::vector<Field>& a, const std::vector<Field>& b) {
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
        if (const int order = a[i].name.compare(b[i].name); order != 0) return order;
        if (const int order = compare_bytes(a[i].values, b[i].values); order != 0) return order;
    }
    return a.size() < b.size() ? -1 : a.size() > b.size();
}

/// By content, for pieces with one box: two that are equal are the same piece twice.
int compare_content(const Piece& a, const Piece& b) {
    if (const int order = compare_bytes(a.grid.points, b.grid.points); order != 0) return order;
    if (const int order = compare_bytes(a.grid.cells.connectivity, b.grid.cells.connectivity); order != 0) return order;
    if (const int order = compare_fields(a.grid.point_fields, b.grid.point_fields); order != 0) return order;
    return compare_fields(a.grid.cell_fields, b.grid.cell_fields);
}

/// Pieces and what is known of their points; where each stands in the file.
struct Pieces {
    std::vector<Piece> pieces;
    std::vector<std::vector<PointUse>> uses;
    std::vector<Box> boxes;
    std::vector<std::size_t> places; ///< in the file

    std::size_t size() const { return pieces.size(); }

    /// `order[i]` is the number of the piece that becomes the i-th.
    void arrange(const std::vector<std::size_t>& order) {
        const auto arranged = [&](auto& items) {
            auto old = std::exchange(items, {});
            for (const std::size_t i : order) items.push_back(std::move(old[i]));
        };
        arranged(pieces);
        arranged(uses);
        arranged(boxes);
        arranged(places);
    }
    /// An order that the file does not decide.
    std::vector<std::size_t> order_of_content() const {
        std::vector<std::size_t> order(size());
        std::iota(order.begin(), order.end(), std::size_t{0});
        std::ranges::sort(order, [&](std::size_t a, std::size_t b) {
            const auto key = [&](std::size_t i) {
                return std::tuple(boxes[i].lower, boxes[i].upper, pieces[i].grid.points.tuples(),
                                  pieces[i].grid.cells.count());
            };
            if (key(a) != key(b)) return key(a) < key(b);
            const int content = compare_content(pieces[a], pieces[b]);
            return content != 0 ? content < 0 : a < b;
        });
        return order;
    }
    std::vector<std::size_t> order_of_file() const {
        std::vector<std::size_t> order(size());
        for (std::size_t i = 0; i < size(); ++i) order[places[i]] = i;
        return order;
    }
};

Result<Pieces> checked(std::vector<Piece> all) {
    Pieces result;
    result.pieces = std::move(all);
    for (Piece& piece : result.pieces) {
        auto use = check_piece(piece);
        if (!use) return use.error();
        result.uses.push_back(*std::move(use));
        result.boxes.push_back(box_of(piece.grid.points, result.uses.back()));
        result.places.push_back(result.places.size());
        vtk_xml::simplify(piece.grid.cells);
    }
    return result;
}

bool is_empty(const Piece& piece) { return piece.grid.points.tuples() == 0 && piece.grid.cells.count() == 0; }

std::uint64_t count_left_out(const std::vector<Piece>& pieces) {
    std::uint64_t count = 0;
    for (const Piece& piece : pieces)
        count += static_cast<std::uint64_t>(std::ranges::count_if(piece.left_out, [](auto out) { return out != 0; }));
    return count;
}

/// The tolerance in two digits, rounded up.
std::string tolerance_text(double gap) {
    if (gap == 0) return "0";
    const double digit = std::pow(10, std::floor(std::log10(gap)) - 1);
    return fmt::format("{:.2g}", (std::floor(gap / digit) + 1) * digit);
}

void note_seams(const Seams& seams, std::size_t pieces, double shortest_tolerance, std::vector<std::string>& notes) {
    if (seams.ids == IdUse::wrong)
        notes.push_back("the global point numbers of the pieces mean different places and were not used");
    if (seams.ids == IdUse::unshared)
        notes.push_back("no two pieces have a global point number in common, so these were not used");
    notes.push_back(seams.ids == IdUse::trusted
                        ? fmt::format("{} pieces joined by global point numbers: {} points were merged", pieces,
                                      seams.joined.size())
                        : fmt::format("{} pieces joined by equal coordinates: {} points were merged; --keep-pieces "
                                      "keeps them apart",
                                      pieces, seams.joined.size()));
    if (seams.apart + seams.near == 0) return;
    const std::string tolerance = tolerance_text(seams.gap > 0 ? std::max(seams.gap, shortest_tolerance) : 0);
    if (seams.apart > 0)
        notes.push_back(fmt::format(
            "{} points lie at the place of another piece's {} and were kept apart; --merge-points {} joins them",
            seams.apart,
            seams.ids == IdUse::trusted ? "with another global number"
                                        : "which has several there (a crack, or values that jump between cells)",
            tolerance));
    if (seams.near > 0)
        notes.push_back(
            fmt::format("{} points lie up to {:.2g} beside another piece's and were kept apart: surfaces have "
                        "seams there; --merge-points {} joins them",
                        seams.near, seams.gap, tolerance));
}

std::string names_of(const std::vector<Piece>& pieces, const std::vector<std::size_t>& some) {
    constexpr std::size_t max_shown = 4;
    std::string list;
    for (std::size_t i = 0; i < std::min(some.size(), max_shown); ++i)
        list += fmt::format("{}\"{}\"", i == 0 ? "" : ", ", escaped(pieces[some[i]].name));
    if (some.size() > max_shown) list += fmt::format(" and {} more", some.size() - max_shown);
    return list;
}

/// Which points are one, with the pieces in an order that the file does not decide.
Result<Seams> seams_of(Pieces& all, const Progress& progress) {
    all.arrange(all.order_of_content());
    std::vector<SeamPiece> seam_pieces;
    for (std::size_t p = 0; p < all.size(); ++p)
        seam_pieces.push_back({all.pieces[p].grid.points, all.pieces[p].point_ids, all.uses[p], all.boxes[p]});
    return find_seams(seam_pieces, progress);
}

PointNumbers numbers_of(const Pieces& all, const Seams& seams) {
    std::vector<std::uint64_t> points;
    for (const Piece& piece : all.pieces) points.push_back(piece.grid.points.tuples());
    const bool drops = all.size() > 1;
    return PointNumbers::make(points, drops ? std::span(all.uses) : std::span<const std::vector<PointUse>>(),
                              seams.joined);
}

/// 2^-40 of the grid's length, the least tolerance that merge_points() takes, with room for rounding.
double least_tolerance(const std::vector<Box>& boxes) {
    Box whole;
    double length = 0;
    for (const Box& box : boxes) whole.add(box);
    for (std::size_t axis = 0; axis < 3; ++axis) length = std::max(length, whole.upper[axis] - whole.lower[axis]);
    return 0x1p-39 * length;
}

Result<void> leave_out_repeated(Pieces& all, const PointNumbers& numbers, std::vector<std::string>& notes,
                                const Progress& progress) {
    const auto repeated = leave_out_repeated(all.pieces, numbers, progress);
    if (!repeated) return repeated.error();
    if (repeated->left_out > 0)
        notes.push_back(fmt::format("{} cells that an earlier piece has, too, were left out: pieces overlap, {}",
                                    repeated->left_out, names_of(all.pieces, repeated->pieces)));
    return {};
}

Result<void> join_arrays(Pieces& all, const PointNumbers& numbers, const Seams& seams, ReadResult& result,
                         const Progress& progress) {
    auto cells = join_cells(all.pieces, all.order_of_file(), numbers, progress);
    if (!cells) return cells.error();
    result.grid.cells = std::move(cells->cells);
    auto cell_fields = join_cell_fields(all.pieces, cells->first, cells->kept, cells->count, result, progress);
    if (!cell_fields) return cell_fields.error();
    result.grid.cell_fields = *std::move(cell_fields);
    auto point_fields = join_point_fields(all.pieces, numbers, seams.joined, result, progress);
    if (!point_fields) return point_fields.error();
    result.grid.point_fields = *std::move(point_fields);
    auto points = join_points(all.pieces, numbers);
    if (!points) return points.error();
    result.grid.points = *std::move(points);
    return {};
}

} // namespace

Result<ReadResult> join(Loaded loaded, const ReadOptions& options, const Progress& progress) {
    ReadResult result;
    result.info = std::move(loaded.info);
    result.step = loaded.step;
    result.notes = std::move(loaded.notes);
    std::vector<Piece>& pieces = loaded.pieces;
    if (std::ranges::all_of(pieces, [](const Piece& piece) { return piece.grid.cells.count() == 0; }))
        for (const Piece& piece : pieces)
            if (!piece.flat.empty()) return broken(piece.name, piece.flat + " has no cells with a volume");
    for (Piece& piece : pieces)
        if (piece.grid.cells.count() == 0) piece.grid.cells = {}; // offsets of no cells need no types
    if (pieces.size() > 1) std::erase_if(pieces, is_empty);
    if (pieces.empty()) { // none has a point
        result.grid.points = Array(ScalarType::float32, nullptr, 0, 3, nullptr);
        return result;
    }
    if (pieces.size() == 1 && pieces[0].left_out.empty()) {
        if (const auto sound = check_shape(pieces[0]); !sound) return sound.error();
        result.grid = std::move(pieces[0].grid);
        result.cells_in_file = pieces[0].cells_in_file;
        return result;
    }

    auto all = checked(std::move(pieces));
    if (!all) return all.error();
    if (const std::uint64_t count = count_left_out(all->pieces); count > 0)
        result.notes.push_back(fmt::format("{} ghost or blanked cells were left out", count));
    Seams seams;
    const bool apart = !options.merge_pieces_by_coordinates;
    if (all->size() > 1 && apart)
        result.notes.push_back(fmt::format("{} pieces lie side by side: surfaces have seams between them since points "
                                           "of different pieces were to be kept apart (--keep-pieces)",
                                           all->size()));
    if (all->size() > 1 && !apart) {
        auto found = seams_of(*all, progress);
        if (!found) return found.error();
        seams = *std::move(found);
        note_seams(seams, all->size(), least_tolerance(all->boxes), result.notes);
        if (seams.joined.empty()) all->arrange(all->order_of_file()); // nothing that the order could decide
    }
    const PointNumbers numbers = numbers_of(*all, seams);
    if (auto done = leave_out_repeated(*all, numbers, result.notes, progress); !done) return done.error();
    if (auto done = join_arrays(*all, numbers, seams, result, progress); !done) return done.error();
    return result;
}

} // namespace isotet::io
