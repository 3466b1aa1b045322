// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/pieces/block_choice.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "grid/points/used_points.hpp"
#include "io/files/escape.hpp"
#include "io/pieces/join/join.hpp"

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
    const std::vector<std::uint8_t> kept = core::keep_used_points(piece.grid);
    if (!kept.empty()) piece.point_ids = core::kept_tuples(piece.point_ids, kept);
}

Result<void> drop_left_out_cells(Piece& piece) {
    if (!piece.cell_ids.empty()) {
        std::vector<std::uint8_t> kept;
        for (const std::uint8_t mark : piece.left_out) kept.push_back(mark == 0);
        piece.cell_ids = core::kept_tuples(piece.cell_ids, kept);
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
