// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/pieces/region_choice.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "io/pieces/block_choice.hpp"

namespace isotet::io {
namespace {

struct Numbered {
    std::string_view format, field;
};
constexpr std::array numbered{Numbered{"gmsh", "gmsh:physical"}, Numbered{"medit", "medit:ref"},
                              Numbered{"tetgen", "region_0"}};

/// Points, lines and faces: their groups have numbers of their own.
constexpr bool has_volume(std::uint8_t type) {
    constexpr std::array flat{1,  2,  3,  4,  5,  6,  7,  8,  9,  21, 22, 23, 28,
                              30, 34, 35, 36, 60, 61, 62, 68, 69, 70, 75, 76, 77};
    return std::ranges::find(flat, int{type}) == flat.end();
}

/// A region of each cell; nothing for cells without volume and for numbers that are none.
constexpr std::int64_t no_region = std::numeric_limits<std::int64_t>::min();

std::vector<std::int64_t> regions_of(const Cells& cells, const Array& numbers) {
    std::vector<std::int64_t> regions(cells.count(), no_region);
    for (std::size_t cell = 0; cell < regions.size(); ++cell) {
        const double number = numbers.at(cell);
        const bool volume = cells.types.empty() || has_volume(static_cast<std::uint8_t>(cells.types.at(cell)));
        constexpr double most = 1LL << 53;
        if (volume && std::abs(number) <= most && number == std::floor(number))
            regions[cell] = static_cast<std::int64_t>(number);
    }
    return regions;
}

/// In the order of their numbers.
std::vector<BlockInfo> listed(const std::vector<std::int64_t>& regions, std::string_view field, const FileInfo& info) {
    std::map<std::int64_t, std::uint64_t> counts;
    std::int64_t last = no_region;
    std::uint64_t* count = nullptr;
    for (const std::int64_t region : regions) {
        if (region == no_region) continue;
        if (!count || region != last) count = &counts[last = region];
        ++*count;
    }
    std::vector<BlockInfo> blocks;
    for (const auto& [number, cells] : counts) {
        const auto named = std::ranges::find_if(
            info.regions, [&](const RegionName& region) { return region.field == field && region.number == number; });
        blocks.push_back({number, named == info.regions.end() ? std::string() : named->name, "region", cells});
    }
    return blocks;
}

} // namespace

std::string_view region_field(const FileInfo& info) {
    const std::span<const Numbered> all = numbered; // an array's iterator is a pointer in some libraries only
    const auto known = std::ranges::find(all, info.format, &Numbered::format);
    if (known == all.end()) return {};
    const bool there = std::ranges::any_of(info.fields, [&](const FieldInfo& field) {
        return field.association == Association::cell && field.name == known->field;
    });
    return there ? known->field : std::string_view();
}

Result<void> choose_regions(ReadResult& result, const ReadOptions& options) {
    const std::string_view name = region_field(result.info);
    const auto field = std::ranges::find(result.grid.cell_fields, name, &Field::name);
    if (field == result.grid.cell_fields.end())
        return Error{ErrorCode::internal, fmt::format("the field {} of regions was not read", name)};
    const std::vector<std::int64_t> regions = regions_of(result.grid.cells, field->values);
    result.info.blocks = listed(regions, name, result.info);
    const auto chosen = chosen_blocks(result.info.blocks, options);
    if (!chosen) return chosen.error();
    Piece piece;
    piece.left_out.assign(regions.size(), 1);
    std::map<std::int64_t, bool> is_chosen;
    for (std::size_t i = 0; i < chosen->size(); ++i) is_chosen[result.info.blocks[i].number] = (*chosen)[i];
    std::uint64_t kept = 0;
    for (std::size_t cell = 0; cell < regions.size(); ++cell) {
        if (regions[cell] == no_region || !is_chosen.at(regions[cell])) continue;
        piece.left_out[cell] = 0;
        ++kept;
    }
    piece.grid = std::move(result.grid);
    if (auto dropped = drop_left_out_cells(piece); !dropped) return dropped;
    result.grid = std::move(piece.grid);
    result.notes.push_back(fmt::format("{} of {} cells are in the chosen regions", kept, regions.size()));
    return {};
}

} // namespace isotet::io
