// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/pieces/cell_field_means.hpp"

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <isotet/fields.hpp>

#include "base/system/memory.hpp"
#include "grid/cells.hpp"
#include "grid/values/cell_means.hpp"
#include "io/pieces/cells_in_order.hpp"

namespace isotet::io {
namespace {

/// A field that was left in the file, and which of its scalars is meant.
struct Found {
    const UnreadField* field;
    core::Scalar scalar;
};

std::optional<Found> find_unread(const Piece& piece, const std::string& name) {
    std::vector<std::string> names;
    for (const UnreadField& field : piece.unread_fields) names.push_back(field.name);
    const auto match = match_field_name(name, names);
    if (!match || !match->parts.empty()) return std::nullopt;
    const auto field = std::ranges::find(piece.unread_fields, match->field, &UnreadField::name);
    if (field == piece.unread_fields.end()) return std::nullopt;
    if (!match->component) return field->components == 1 ? std::optional(Found{&*field, {}}) : std::nullopt;
    const auto scalar = core::CellMeans::scalar_called(*match->component);
    if (!scalar || scalar->component >= field->components) return std::nullopt;
    return Found{&*field, *scalar};
}

} // namespace

Result<std::optional<PointField>> means_of_cells(const Piece& piece, const std::string& name,
                                                 const Progress& progress) {
    const std::optional<PointField> nothing;
    const Array& points = piece.grid.points;
    const CellPlaces& places = piece.unread->places();
    const auto found = find_unread(piece, name);
    if (!found || !places.all_have_volumes()) return nothing;
    const auto values = found->field->values->read();
    if (!values && values.error().code == ErrorCode::invalid_data) return nothing;
    if (!values) return values.error();
    if (values->tuples() != places.cells()) return nothing;
    if (auto enough = core::require_memory("averaging a cell field", core::CellMeans::bytes(points.tuples())); !enough)
        return enough.error();
    core::CellMeans means(points);
    bool broken = !means.are_sound();
    if (broken) return nothing;
    const auto done = cells_in_turn(*piece.unread, points).each([&](std::uint64_t first, const Grid& some) {
        if (broken || progress.cancelled()) return;
        const auto cells = core::CellReader::open(some);
        const auto is_there = [&](std::uint64_t corner) { return corner < points.tuples(); };
        broken = !cells || !std::ranges::all_of(some.cells.connectivity.as<std::uint64_t>(), is_there);
        if (!broken) means.add(*cells, *values, found->scalar, first);
    });
    if (!done) return done.error();
    if (progress.cancelled()) return Error{ErrorCode::cancelled, "averaging a cell field was cancelled"};
    if (broken) return nothing;
    return std::optional(PointField{name, std::move(means).finish(values->type()), true, {}});
}

} // namespace isotet::io
