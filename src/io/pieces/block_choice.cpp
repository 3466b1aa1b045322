// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/pieces/block_choice.hpp"

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "grid/cell_faces.hpp"
#include "grid/patches.hpp"
#include "io/files/escape.hpp"
#include "io/pieces/join.hpp"

namespace isotet::io {

namespace {

/// Whole parts of a name such as "solid/left/wall": "wall", "left", "solid/left".
bool has_name(const BlockInfo& block, const std::string& asked) {
    return !block.name.empty() && !asked.empty() &&
           ("/" + block.name + "/").find("/" + asked + "/") != std::string::npos;
}

/// The numbers of the blocks that one word asks for.
std::vector<std::size_t> found_by(const std::vector<BlockInfo>& blocks, const std::string& asked) {
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < blocks.size(); ++i)
        if (has_name(blocks[i], asked)) found.push_back(i);
    for (std::size_t i = 0; found.empty() && i < blocks.size(); ++i)
        if (std::to_string(blocks[i].number) == asked) return {i};
    return found;
}

std::string list_of(const std::vector<BlockInfo>& blocks) {
    constexpr std::size_t max_shown = 20;
    std::string list;
    for (std::size_t i = 0; i < std::min(blocks.size(), max_shown); ++i) {
        list += fmt::format("{}{}", i == 0 ? "" : ", ", blocks[i].number);
        if (!blocks[i].name.empty()) list += fmt::format(" '{}'", escaped(blocks[i].name));
    }
    if (blocks.size() > max_shown) list += fmt::format(" and {} more", blocks.size() - max_shown);
    return list;
}

/// Streams that do not fit stay: the checks of what was read say so.
template <class Number>
void renumber_faces(Cells& cells, const Number& number) {
    const auto faces = core::FaceReader::open(cells);
    if (!faces || !faces->has_faces()) return;
    std::vector<std::int64_t> stream(cells.faces.size());
    for (std::size_t i = 0; i < stream.size(); ++i) stream[i] = static_cast<std::int64_t>(faces->at(i));
    for (std::size_t cell = 0; cell < cells.count(); ++cell) {
        if (!core::fault_of_faces(*faces, cell, std::numeric_limits<std::uint64_t>::max()).empty()) return;
        for (std::uint64_t at = faces->begin(cell) + 1; at < faces->end(cell);)
            for (std::uint64_t left = faces->at(at++); left > 0; --left, ++at) stream[at] = number(faces->at(at));
    }
    cells.faces = Array::own(std::move(stream));
}

/// The tuples of `values` whose number `kept` marks.
Array kept_tuples(const Array& values, const std::vector<std::uint8_t>& kept, std::size_t count) {
    if (values.empty()) return values;
    return values.visit([&](auto from) {
        using Value = std::remove_const_t<typename decltype(from)::value_type>;
        const std::size_t width = values.components();
        std::vector<Value> to;
        to.reserve(count * width);
        for (std::size_t i = 0; i < kept.size(); ++i)
            if (kept[i]) to.insert(to.end(), from.begin() + i * width, from.begin() + (i + 1) * width);
        return Array::own(std::move(to), width);
    });
}

} // namespace

Result<std::vector<bool>> chosen_blocks(const std::vector<BlockInfo>& blocks, const ReadOptions& options) {
    std::vector<bool> chosen(blocks.size(), options.blocks.empty());
    for (const std::string& asked : options.blocks) {
        const std::vector<std::size_t> found = found_by(blocks, asked);
        if (found.empty())
            return Error{
                ErrorCode::invalid_argument,
                blocks.empty()
                    ? fmt::format("block '{}' is not in the file, which has no blocks to choose from", escaped(asked))
                    : fmt::format("block '{}' is not in the file, which has {}", escaped(asked), list_of(blocks))};
        for (const std::size_t i : found) chosen[i] = true;
    }
    return chosen;
}

void announce_block(FileInfo& info, const BlockInfo& block) {
    const auto known = std::ranges::find_if(info.blocks, [&](const BlockInfo& other) {
        return other.number == block.number && other.name == block.name && other.kind == block.kind;
    });
    if (known == info.blocks.end()) info.blocks.push_back(block);
    else known->cells += block.cells;
}

void drop_unused_points(Piece& piece) {
    Grid& grid = piece.grid;
    const std::size_t count = grid.points.tuples();
    std::vector<std::uint8_t> used(count);
    std::vector<std::int64_t> corners(grid.cells.connectivity.size());
    grid.cells.connectivity.visit([&](auto from) {
        for (std::size_t i = 0; i < corners.size(); ++i) {
            corners[i] = static_cast<std::int64_t>(from[i]);
            const auto point = static_cast<std::size_t>(corners[i]);
            if (point < count) used[point] = 1;
        }
    });
    std::vector<std::int64_t> place(count, -1);
    std::int64_t next = 0;
    for (std::size_t i = 0; i < count; ++i)
        if (used[i]) place[i] = next++;
    if (static_cast<std::size_t>(next) == count) return;
    for (std::int64_t& corner : corners)
        if (static_cast<std::size_t>(corner) < count) corner = place[static_cast<std::size_t>(corner)];
        else corner = next; // still no point: the checks of what was read say so
    grid.patches = core::renumbered(grid.patches,
                                    [&](std::uint64_t point) { return point < count ? place[point] : std::int64_t{-1}; });
    const auto kept = static_cast<std::size_t>(next);
    renumber_faces(grid.cells, [&](std::uint64_t point) { return point < count ? place[point] : next; });
    grid.cells.connectivity = Array::own(std::move(corners));
    grid.points = kept_tuples(grid.points, used, kept);
    grid.point_numbers = kept_tuples(grid.point_numbers, used, kept);
    piece.point_ids = kept_tuples(piece.point_ids, used, kept);
    for (Field& field : grid.point_fields) field.values = kept_tuples(field.values, used, kept);
}

Result<void> drop_left_out_cells(Piece& piece) {
    if (!piece.cell_ids.empty()) {
        std::vector<std::uint8_t> kept;
        for (const std::uint8_t mark : piece.left_out) kept.push_back(mark == 0);
        const auto count = static_cast<std::size_t>(std::ranges::count(kept, 1));
        piece.cell_ids = kept_tuples(piece.cell_ids, kept, count);
    }
    Loaded loaded;
    Piece& all = loaded.pieces.emplace_back();
    all.grid = std::move(piece.grid);
    all.left_out = std::exchange(piece.left_out, {});
    auto rest = join(std::move(loaded), {}); // its notes speak of ghost cells
    if (!rest) return rest.error();
    piece.grid = std::move(rest->grid);
    drop_unused_points(piece);
    return {};
}

} // namespace isotet::io
