// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/pieces/join/chosen_cells.hpp"

#include <algorithm>
#include <atomic>
#include <type_traits>
#include <utility>

#include "base/system/memory.hpp"
#include "grid/values/values_in_ranges.hpp"

namespace isotet::io {
namespace {

bool is_rounded(const Array& points) { return points.type() == ScalarType::float64; }

/// One more condition for the cells of a piece. False where its field is not as it must be, of `type` if that is known.
Result<bool> restrict_piece(const Piece& piece, const CellCondition& condition, std::optional<ScalarType>& type,
                            std::vector<bool>& is_there, std::span<std::uint8_t> chosen) {
    const auto field = std::ranges::find(piece.unread_fields, condition.field, &UnreadField::name);
    if (field == piece.unread_fields.end() || field->components != 1) return false;
    const auto values = field->values->read();
    if (!values) return values.error().code == ErrorCode::invalid_data ? Result<bool>(false) : values.error();
    if (values->size() != chosen.size() || values->type() != type.value_or(values->type())) return false;
    type = values->type();
    const auto found = core::restrict_to_ranges(*values, condition.ranges, condition.others, piece.left_out, chosen);
    for (std::size_t i = 0; i < found.size(); ++i) is_there[i] = is_there[i] || found[i];
    return true;
}

} // namespace

Result<std::optional<ChosenCells>> ChosenCells::find(const OrderedPieces& all,
                                                     std::span<const CellCondition> conditions,
                                                     const std::vector<std::uint64_t>& first,
                                                     std::optional<CellType> type) {
    const std::optional<ChosenCells> nothing;
    const std::vector<std::size_t> order = all.order_of_file();
    std::uint64_t cells = 0;
    for (const Piece& piece : all.pieces) cells += piece.cell_count();
    if (auto enough = core::require_memory("choosing cells", cells); !enough) return enough.error();
    ChosenCells result;
    result.origin_ = first[order.front()];
    result.corners_of_type_ = type ? core::fixed_corners_of(static_cast<std::uint8_t>(*type)) : 0;
    result.chosen_.assign(cells, 1);
    std::vector<std::optional<ScalarType>> types(conditions.size());
    std::vector<std::vector<bool>> is_there;
    for (const CellCondition& condition : conditions) is_there.emplace_back(condition.ranges.size(), false);
    std::uint64_t of_all = 0;
    for (const std::size_t p : order) {
        const Piece& piece = all.pieces[p];
        if (piece.cell_count() == 0) continue;
        if (!piece.unread->places().all_have_volumes()) return nothing;
        const auto chosen = std::span(result.chosen_).subspan(first[p] - result.origin_, piece.cell_count());
        for (std::size_t i = 0; i < piece.left_out.size(); ++i)
            if (piece.left_out[i] != 0) chosen[i] = 0;
        of_all +=
            piece.cell_count() -
            (piece.left_out.size() - static_cast<std::uint64_t>(std::ranges::count(piece.left_out, std::uint8_t{0})));
        for (std::size_t i = 0; i < conditions.size(); ++i) {
            const auto done = restrict_piece(piece, conditions[i], types[i], is_there[i], chosen);
            if (!done) return done.error();
            if (!*done) return nothing;
        }
    }
    for (const std::vector<bool>& each : is_there)
        if (std::ranges::find(each, false) != each.end()) return nothing;
    result.count_ = static_cast<std::uint64_t>(std::ranges::count(result.chosen_, std::uint8_t{1}));
    if (result.count_ == 0) return nothing;
    result.all_ = result.count_ == of_all;
    return std::optional(std::move(result));
}

void ChosenCells::mark(std::uint64_t point) {
    if (point >= used_.size()) return; // broken cells are told when all are there
    const std::atomic_ref<std::uint8_t> used(used_[point]);
    if (used.load(std::memory_order_relaxed) == 0) used.store(1, std::memory_order_relaxed);
}

void ChosenCells::take(std::uint64_t first, std::span<const std::uint8_t> types, const Array& corners) {
    each_run(first, types, corners, [&](std::uint64_t, std::span<const std::uint8_t>, const Array& some) {
        some.visit([&]<class Index>(std::span<const Index> points) {
            if constexpr (std::is_integral_v<Index>)
                for (const Index point : points) mark(static_cast<std::uint64_t>(point));
        });
    });
}

bool ChosenCells::leave_values(Grid& grid) const {
    if (is_rounded(grid.points) && box_of(grid.points, {}) != box_of(grid.points, used_points())) return false;
    for (Field& field : grid.point_fields) field.values = core::without_unused(field.values, used_);
    return true;
}

std::vector<PointUse> ChosenCells::used_points() const {
    std::vector<PointUse> use(used_.size());
    std::ranges::transform(used_, use.begin(),
                           [](std::uint8_t used) { return used ? PointUse::kept : PointUse::none; });
    return use;
}

} // namespace isotet::io
