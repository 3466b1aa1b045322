// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/pieces/join/field_digests.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <numeric>
#include <span>
#include <string>
#include <utility>

#include "grid/values/value_digest.hpp"

namespace isotet::io {
namespace {

constexpr std::uint64_t cells_of_part = std::uint64_t{1} << 20;

/// Of all cells of a piece; NaN where it does not have the field.
Result<void> add_values(const std::string& name, const Piece& piece, core::ValueDigest& digest,
                        const Progress& progress) {
    const auto field = std::ranges::find(piece.unread_fields, name, &UnreadField::name);
    if (field == piece.unread_fields.end()) {
        digest.add(Array::own(std::vector<double>{std::numeric_limits<double>::quiet_NaN()}), {});
        return {};
    }
    const std::uint64_t count = piece.cell_count();
    for (std::uint64_t begin = 0; begin < count; begin += cells_of_part) {
        if (progress.cancelled()) return Error{ErrorCode::cancelled, "looking at cell fields was cancelled"};
        std::vector<std::uint64_t> cells(std::min(cells_of_part, count - begin));
        std::iota(cells.begin(), cells.end(), begin);
        const auto values = field->values->read(cells);
        if (!values) return values.error();
        const std::span<const std::uint8_t> out(piece.left_out);
        digest.add(*values, out.empty() ? out : out.subspan(begin, cells.size()));
    }
    return {};
}

} // namespace

Result<std::optional<std::vector<Field>>> digests_of(const OrderedPieces& all, const std::vector<Field>& joined,
                                                     const Progress& progress) {
    const std::optional<std::vector<Field>> nothing;
    std::vector<const Piece*> pieces;
    for (const std::size_t p : all.order_of_file())
        if (all.pieces[p].cell_count() > 0) pieces.push_back(&all.pieces[p]);
    if (!std::ranges::all_of(pieces, [](const Piece* piece) { return piece->unread->places().all_have_volumes(); }))
        return nothing;
    std::vector<Field> digests;
    for (const Field& named : joined) {
        if (named.values.components() != 1) continue;
        core::ValueDigest digest;
        for (const Piece* piece : pieces) {
            const auto added = add_values(named.name, *piece, digest, progress);
            if (!added && added.error().code == ErrorCode::invalid_data) return nothing;
            if (!added) return added.error();
        }
        digests.push_back({named.name, digest.values()});
    }
    return std::optional(std::move(digests));
}

} // namespace isotet::io
