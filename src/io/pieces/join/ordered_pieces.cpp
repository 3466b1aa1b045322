// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/pieces/join/ordered_pieces.hpp"

#include <cmath>
#include <cstring>
#include <numeric>
#include <span>
#include <string_view>
#include <tuple>

#include <fmt/format.h>

#include "io/files/escape.hpp"

namespace isotet::io {

int compare_bytes(const Array& a, const Array& b) {
    if (a.bytes() != b.bytes()) return a.bytes() < b.bytes() ? -1 : 1;
    return a.bytes() == 0 ? 0 : std::memcmp(a.data(), b.data(), a.bytes());
}

namespace {

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
Result<Seams> seams_of(OrderedPieces& all, const Progress& progress) {
    all.arrange(all.order_of_content());
    std::vector<SeamPiece> seam_pieces;
    for (std::size_t p = 0; p < all.size(); ++p)
        seam_pieces.push_back({all.pieces[p].grid.points, all.pieces[p].point_ids, all.uses[p], all.boxes[p]});
    return find_seams(seam_pieces, progress);
}

PointNumbers numbers_of(const OrderedPieces& all, const Seams& seams) {
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

} // namespace

std::vector<std::size_t> OrderedPieces::order_of_content() const {
    std::vector<std::size_t> order(size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::sort(order, [&](std::size_t a, std::size_t b) {
        const auto key = [&](std::size_t i) {
            return std::tuple(boxes[i].lower, boxes[i].upper, pieces[i].grid.points.tuples(), pieces[i].cell_count());
        };
        if (key(a) != key(b)) return key(a) < key(b);
        const int content = compare_content(pieces[a], pieces[b]);
        return content != 0 ? content < 0 : a < b;
    });
    return order;
}

Result<JoinedNumbers> number_points(OrderedPieces& all, const ReadOptions& options, std::vector<std::string>& notes,
                                    const Progress& progress) {
    JoinedNumbers result;
    const bool apart = !options.merge_pieces_by_coordinates;
    if (all.size() > 1 && apart)
        notes.push_back(fmt::format("{} pieces lie side by side: surfaces have seams between them since points "
                                    "of different pieces were to be kept apart (--keep-pieces)",
                                    all.size()));
    if (all.size() > 1 && !apart) {
        auto found = seams_of(all, progress);
        if (!found) return found.error();
        result.seams = *std::move(found);
        note_seams(result.seams, all.size(), least_tolerance(all.boxes), notes);
        if (result.seams.joined.empty()) all.arrange(all.order_of_file()); // nothing that the order could decide
    }
    result.numbers = numbers_of(all, result.seams);
    return result;
}

void note_left_out(const std::vector<Piece>& pieces, std::vector<std::string>& notes) {
    std::uint64_t count = 0;
    for (const Piece& piece : pieces)
        count += static_cast<std::uint64_t>(std::ranges::count_if(piece.left_out, [](auto out) { return out != 0; }));
    if (count > 0) notes.push_back(fmt::format("{} ghost or blanked cells were left out", count));
}

void note_repeated(const RepeatedCells& repeated, const std::vector<Piece>& pieces, std::vector<std::string>& notes) {
    if (repeated.left_out > 0)
        notes.push_back(fmt::format("{} cells that an earlier piece has, too, were left out: pieces overlap, {}",
                                    repeated.left_out, names_of(pieces, repeated.pieces)));
}

} // namespace isotet::io
