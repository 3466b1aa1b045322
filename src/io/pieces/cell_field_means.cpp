// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/pieces/cell_field_means.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <tuple>
#include <utility>

#include <isotet/fields.hpp>

#include "base/parallel.hpp"
#include "base/system/memory.hpp"
#include "fields/expression/find_expression.hpp"
#include "fields/fill_values.hpp"
#include "grid/cells.hpp"
#include "grid/values/cell_means.hpp"
#include "io/pieces/cells_in_order.hpp"

namespace isotet::io {
namespace {

/// One value a cell, and which of its scalars is meant.
struct CellValues {
    std::string name;
    Array values;
    core::Scalar scalar;
};

bool have_same_fields(const Piece& a, const Piece& b) {
    return std::ranges::equal(a.unread_fields, b.unread_fields, [](const UnreadField& one, const UnreadField& other) {
        return std::tie(one.name, one.type, one.components) == std::tie(other.name, other.type, other.components);
    });
}

Result<std::optional<CellValues>> read_expression(const Piece& piece, const std::string& text,
                                                  const Progress& progress) {
    std::vector<std::string> names;
    for (const UnreadField& field : piece.unread_fields) names.push_back(field.name);
    const auto needed = needs_of_expression(text, names);
    if (!needed) return needed.error();
    std::vector<Field> fields;
    for (const UnreadField& field : piece.unread_fields) {
        if (std::ranges::find(needed->fields, field.name) == needed->fields.end()) continue;
        auto values = field.values->read();
        if (!values) return values.error();
        fields.push_back({field.name, *std::move(values)});
    }
    auto found = core::expression_in_cells(fields, piece.cell_count(), text, progress);
    if (!found) return found.error();
    if (!*found) return std::optional<CellValues>();
    return std::optional(CellValues{std::move((*found)->name), std::move((*found)->values), {}});
}

/// Nothing where the name means no field that was left in the file, or several.
Result<std::optional<CellValues>> read_values(const Piece& piece, const std::string& name, const Progress& progress) {
    const std::optional<CellValues> nothing;
    std::vector<std::string> names;
    for (const UnreadField& field : piece.unread_fields) names.push_back(field.name);
    const auto match = match_field_name(name, names);
    if (!match && !names.empty() && looks_like_expression(name)) return read_expression(piece, name, progress);
    if (!match || !match->parts.empty()) return nothing;
    const auto field = std::ranges::find(piece.unread_fields, match->field, &UnreadField::name);
    core::Scalar scalar;
    if (match->component) {
        const auto asked = core::CellMeans::scalar_called(*match->component);
        const auto place = asked ? asked->place_in(field->components) : std::nullopt;
        if (!place) return nothing;
        scalar = {*place, asked->magnitude};
    } else if (field->components != 1) {
        return nothing;
    }
    auto values = field->values->read();
    if (!values) return values.error();
    return std::optional(CellValues{name, *std::move(values), scalar});
}

/// Cells that are left out have no value.
void leave_out_values(CellValues& read, const std::vector<std::uint8_t>& left_out) {
    if (left_out.empty()) return;
    std::vector<double> values(left_out.size(), std::numeric_limits<double>::quiet_NaN());
    for (std::size_t cell = 0; cell < values.size(); ++cell)
        if (left_out[cell] == 0) values[cell] = core::scalar_at(read.values, read.scalar, cell);
    read.values = Array::own(std::move(values));
    read.scalar = {};
}

/// Adds the cells of one piece.
class PieceAdder {
public:
    PieceAdder(core::CellMeans& means, const Array& points, const NumberedPiece& numbered, const CellValues& read)
        : means_(means), points_(points), numbered_(numbered), read_(read) {}

    /// False where a cell is broken.
    Result<bool> add(const Progress& progress) {
        const auto done = cells_in_turn(*numbered_.piece->unread, points_).each([&](std::uint64_t first, Grid some) {
            if (broken_ || progress.cancelled()) return;
            if (numbered_.numbers) number(some.cells.connectivity);
            const auto cells = core::CellReader::open(some);
            broken_ = !cells || !all_are_there(*cells, some.cells.connectivity.as<std::uint64_t>(), first);
            if (!broken_) means_.add(*cells, read_.values, read_.scalar, first);
        });
        if (!done) return done.error();
        if (progress.cancelled()) return Error{ErrorCode::cancelled, "averaging a cell field was cancelled"};
        return !broken_;
    }

private:
    void number(Array& connectivity) const {
        const auto corners = connectivity.as<std::uint64_t>();
        std::vector<std::uint64_t> numbers(corners.size());
        core::parallel_each(numbers.size(), std::size_t{1} << 14, [&](std::size_t i) {
            numbers[i] = corners[i] < numbered_.points ? (*numbered_.numbers)(corners[i]) : PieceNumbers::none;
        });
        connectivity = Array::own(std::move(numbers));
    }

    /// Whether cells have their points; those that are left out need not.
    bool all_are_there(const core::CellReader& cells, std::span<const std::uint64_t> corners,
                       std::uint64_t first) const {
        const std::uint64_t points = points_.tuples();
        const auto is_there = [&](std::uint64_t corner) { return corner < points; };
        if (std::ranges::all_of(corners, is_there)) return true;
        const std::vector<std::uint8_t>& out = numbered_.piece->left_out;
        for (std::size_t cell = 0; cell < cells.count(); ++cell) {
            if (!out.empty() && out[first + cell] != 0) continue;
            const std::uint64_t begin = cells.first(cell), end = begin + cells.corners(cell);
            for (std::uint64_t i = begin; i < end; ++i)
                if (!is_there(cells.corner(i))) return false;
        }
        return true;
    }

    core::CellMeans& means_;
    const Array& points_;
    const NumberedPiece& numbered_;
    const CellValues& read_;
    bool broken_ = false;
};

} // namespace

Result<std::optional<PointField>> means_of_cells(const std::vector<NumberedPiece>& pieces, const Array& points,
                                                 const std::string& name, const Progress& progress) {
    const std::optional<PointField> nothing;
    for (const NumberedPiece& one : pieces)
        if (!one.piece->unread->places().all_have_volumes() || !have_same_fields(*one.piece, *pieces.front().piece))
            return nothing;
    if (auto enough = core::require_memory("averaging a cell field", core::CellMeans::bytes(points.tuples())); !enough)
        return enough.error();
    core::CellMeans means(points);
    if (!means.are_sound()) return nothing;
    std::optional<ScalarType> type;
    std::string text;
    core::FillFinder fill;
    for (const NumberedPiece& one : pieces) {
        auto read = read_values(*one.piece, name, progress);
        const bool is_told_by_all =
            !read && (read.error().code == ErrorCode::invalid_data || read.error().code == ErrorCode::invalid_argument);
        if (is_told_by_all) return nothing;
        if (!read) return read.error();
        if (!*read || (*read)->values.tuples() != one.piece->cell_count()) return nothing;
        if (type.value_or((*read)->values.type()) != (*read)->values.type()) return nothing;
        type = (*read)->values.type();
        text = (*read)->name;
        leave_out_values(**read, one.piece->left_out);
        if (auto looked =
                fill.add(core::CellMeans::scalar_of_cells((*read)->values, (*read)->scalar), {.progress = progress});
            !looked)
            return looked.error();
        const auto added = PieceAdder(means, points, one, **read).add(progress);
        if (!added) return added.error();
        if (!*added) return nothing;
    }
    if (!type) return nothing;
    PointField found{text, std::move(means).finish(*type), true, {}};
    found.cell_fill = fill.find();
    return std::optional(std::move(found));
}

} // namespace isotet::io
