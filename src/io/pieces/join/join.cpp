// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/pieces/join/join.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "base/parallel.hpp"
#include "grid/patches.hpp"
#include "io/files/first_error.hpp"
#include "io/pieces/join/join_active.hpp"
#include "io/pieces/join/joined_cells.hpp"
#include "io/pieces/join/joined_fields.hpp"
#include "io/pieces/join/ordered_pieces.hpp"
#include "io/pieces/survey_unread.hpp"
#include "io/pieces/uniform_cells.hpp"

namespace isotet::io {
namespace {

Result<OrderedPieces> checked(std::vector<Piece> all) {
    OrderedPieces result;
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

bool is_empty(const Piece& piece) { return piece.grid.points.tuples() == 0 && piece.cell_count() == 0; }

/// Why each field of a piece that is still in its file cannot be read; nothing where it can.
using WhyNot = std::vector<std::optional<std::string>>;

Result<WhyNot> read_fields_of(Piece& piece) {
    WhyNot why_not;
    for (const UnreadField& field : std::exchange(piece.unread_fields, {})) {
        auto values = field.values->read();
        if (!values && values.error().code != ErrorCode::invalid_data) return values.error();
        why_not.push_back(values ? std::nullopt : std::optional(values.error().message));
        if (values) piece.grid.cell_fields.push_back({field.name, *std::move(values)});
    }
    return why_not;
}

/// Reads the cells that are still in their files, and their fields. Those that cannot be read are left out.
Result<void> read_cells_of(std::vector<Piece>& pieces, FileInfo& info) {
    std::vector<std::vector<UnreadField>> fields;
    for (const Piece& piece : pieces) fields.push_back(piece.unread_fields);
    std::vector<WhyNot> why_not(pieces.size());
    FirstError failed;
    core::parallel_each(pieces.size(), 1, [&](std::size_t i) {
        if (failed) return;
        auto read = read_fields_of(pieces[i]);
        if (!read) return failed.add(i, read.error());
        why_not[i] = *std::move(read);
        if (!pieces[i].unread) return;
        auto cells = pieces[i].unread->read();
        if (!cells) return failed.add(i, cells.error());
        pieces[i].grid.cells = *std::move(cells);
        pieces[i].unread.reset();
    });
    for (std::size_t i = 0; i < pieces.size(); ++i)
        for (std::size_t k = 0; k < why_not[i].size(); ++k)
            if (why_not[i][k]) leave_out(info, {"cell field", fields[i][k].name, *why_not[i][k]});
    return failed.result();
}

/// Those of all pieces, in the order of the file. Each numbers its patches as the others do.
BoundaryPatches join_patches(const OrderedPieces& all, const PointNumbers& numbers) {
    core::PatchList list;
    for (const std::size_t p : all.order_of_file())
        core::append_patches(
            all.pieces[p].grid.patches,
            [&](std::uint64_t point) { return static_cast<std::int64_t>(numbers.pieces[p](point)); }, list);
    return list.finish();
}

Result<void> join_arrays(OrderedPieces& all, const PointNumbers& numbers, const Seams& seams, ReadResult& result,
                         const Progress& progress) {
    auto cells = join_cells(all.pieces, all.order_of_file(), numbers, progress);
    if (!cells) return cells.error();
    result.grid.cells = std::move(cells->cells);
    result.grid.patches = join_patches(all, numbers);
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

/// The numbers of the cells that are not left out.
Array kept_numbers(const std::vector<std::uint8_t>& left_out) {
    std::vector<std::uint64_t> numbers;
    for (std::uint64_t cell = 0; cell < left_out.size(); ++cell)
        if (left_out[cell] == 0) numbers.push_back(cell);
    return Array::own(std::move(numbers));
}

/// Nothing where `may_free` and pieces that are needed were freed.
/// `counted`   gets the counts, where cells are counted; else null
Result<std::optional<ReadResult>> join_loaded(Loaded loaded, const ReadOptions& options, const Progress& progress,
                                              bool may_free, SurveyedGrid* counted = nullptr) {
    ReadResult result;
    result.info = std::move(loaded.info);
    result.step = loaded.step;
    result.notes = std::move(loaded.notes);
    std::vector<Piece>& pieces = loaded.pieces;
    if (std::ranges::all_of(pieces, [](const Piece& piece) { return piece.cell_count() == 0; }))
        for (const Piece& piece : pieces)
            if (!piece.flat.empty()) return broken(piece.name, piece.flat + " has no cells with an area");
    for (Piece& piece : pieces)
        if (piece.cell_count() == 0) piece.grid.cells = {}; // offsets of no cells need no types
    if (pieces.size() > 1) std::erase_if(pieces, is_empty);
    if (pieces.empty()) { // none has a point
        result.grid.points = Array(ScalarType::float32, nullptr, 0, 3, nullptr);
        return std::optional(std::move(result));
    }
    if (std::ranges::any_of(pieces, [](const Piece& piece) { return piece.unread != nullptr; })) {
        auto active = counted ? join_counted(pieces, result, options, progress, *counted)
                              : join_active(pieces, result, options, progress, may_free);
        if (!active || *active) return active;
        if (pieces.empty()) return std::optional<ReadResult>();
        if (auto read = read_cells_of(pieces, result.info); !read) return read.error();
    }
    if (pieces.size() == 1 && pieces[0].left_out.empty()) {
        if (const auto sound = check_shape(pieces[0]); !sound) return sound.error();
        result.grid = std::move(pieces[0].grid);
        return std::optional(std::move(result));
    }

    if (pieces.size() == 1) result.cell_numbers = kept_numbers(pieces[0].left_out);
    auto all = checked(std::move(pieces));
    if (!all) return all.error();
    note_left_out(all->pieces, result.notes);
    const auto joined = number_points(*all, options, result.notes, progress);
    if (!joined) return joined.error();
    const auto repeated = leave_out_repeated(all->pieces, joined->numbers, progress);
    if (!repeated) return repeated.error();
    note_repeated(*repeated, all->pieces, result.notes);
    if (auto done = join_arrays(*all, joined->numbers, joined->seams, result, progress); !done) return done.error();
    return std::optional(std::move(result));
}

} // namespace

Result<ReadResult> join(Loaded loaded, const ReadOptions& options, const Progress& progress) {
    auto joined = join_loaded(std::move(loaded), options, progress, false);
    if (!joined) return joined.error();
    return **std::move(joined);
}

Result<SurveyedGrid> join_counted(Loaded loaded, const ReadOptions& options, const Progress& progress) {
    if (loaded.pieces.size() == 1) {
        auto surveyed = survey_unread(loaded.pieces[0], options, progress);
        if (!surveyed) return surveyed.error();
        if (*surveyed) {
            ReadResult& read = (*surveyed)->read;
            read.info = std::move(loaded.info);
            read.step = loaded.step;
            read.notes = std::move(loaded.notes);
            return **std::move(surveyed);
        }
    }
    SurveyedGrid counted;
    auto joined = join_loaded(std::move(loaded), options, progress, false, &counted);
    if (!joined) return joined.error();
    counted.read = **std::move(joined);
    return counted;
}

Result<ReadResult> load_and_join(const std::function<Result<Loaded>()>& load, const ReadOptions& options,
                                 const Progress& progress) {
    for (bool may_free = true;; may_free = false) {
        auto loaded = load();
        if (!loaded) return loaded.error();
        auto joined = join_loaded(*std::move(loaded), options, progress, may_free);
        if (!joined) return joined.error();
        if (*joined) return **std::move(joined);
    }
}

} // namespace isotet::io
