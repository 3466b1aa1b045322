// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/pieces/region_choice.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <compare>
#include <cstdint>
#include <limits>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "grid/patches.hpp"
#include "io/pieces/block_choice.hpp"

namespace isotet::io {
namespace {

struct Numbered {
    std::string_view format, field;
};
constexpr std::array numbered{Numbered{"gmsh", "gmsh:physical"}, Numbered{"medit", "medit:ref"},
                              Numbered{"tetgen", "region_0"}};

/// Those of surfaces have numbers of their own, and come behind those of volumes.
struct Region {
    bool of_surface = false;
    std::int64_t number = std::numeric_limits<std::int64_t>::min(); ///< the lowest: none
    auto operator<=>(const Region&) const = default;
};
constexpr Region no_region;

/// A region of each cell; none of points and lines, of surfaces with the number 0, and for numbers that are none.
std::vector<Region> regions_of(const Cells& cells, const Array& numbers) {
    std::vector<Region> regions(cells.count());
    for (std::size_t cell = 0; cell < regions.size(); ++cell) {
        const double number = numbers.at(cell);
        const auto type = static_cast<std::uint8_t>(cells.types.empty() ? static_cast<double>(cells.uniform_type)
                                                                        : cells.types.at(cell));
        const bool of_surface = core::is_flat_cell(type);
        constexpr double most = 1LL << 53;
        if ((of_surface ? number != 0 : core::has_a_volume(type)) && std::abs(number) <= most &&
            number == std::floor(number))
            regions[cell] = {of_surface, static_cast<std::int64_t>(number)};
    }
    return regions;
}

std::string name_of(const Region& region, std::string_view field, const ReadResult& result) {
    if (region.of_surface) {
        const auto& names = result.grid.patches.names;
        const auto named = std::ranges::find(names, region.number, &PatchName::number);
        return named == names.end() ? std::string() : named->name;
    }
    const auto& names = result.info.regions;
    const auto named = std::ranges::find_if(
        names, [&](const RegionName& name) { return name.field == field && name.number == region.number; });
    return named == names.end() ? std::string() : named->name;
}

/// In their order.
std::map<Region, std::uint64_t> counted(const std::vector<Region>& regions) {
    std::map<Region, std::uint64_t> counts;
    Region last;
    std::uint64_t* count = nullptr;
    for (const Region& region : regions) {
        if (region == no_region) continue;
        if (!count || region != last) count = &counts[last = region];
        ++*count;
    }
    return counts;
}

} // namespace

bool may_have_regions(std::string_view format) {
    return std::ranges::find(numbered, format, &Numbered::format) != numbered.end();
}

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
    const std::vector<Region> regions = regions_of(result.grid.cells, field->values);
    const std::map<Region, std::uint64_t> counts = counted(regions);
    for (const auto& [region, cells] : counts)
        result.info.blocks.push_back(
            {region.number, name_of(region, name, result), region.of_surface ? "surface" : "region", cells});
    const auto chosen = chosen_blocks(result.info.blocks, options);
    if (!chosen) return chosen.error();
    std::map<Region, bool> is_chosen{{no_region, false}};
    for (auto at = chosen->begin(); const auto& [region, cells] : counts) is_chosen[region] = *at++;
    Piece piece;
    std::uint64_t kept = 0;
    for (const Region& region : regions) {
        const bool keeps = is_chosen.at(region);
        piece.left_out.push_back(keeps ? 0 : 1);
        kept += keeps;
    }
    if (!options.patches) result.grid.patches = {}; // they were read for their names
    piece.grid = std::move(result.grid);
    if (auto dropped = drop_left_out_cells(piece); !dropped) return dropped;
    result.grid = std::move(piece.grid);
    result.notes.push_back(fmt::format("{} of {} cells are in the chosen regions", kept, regions.size()));
    return {};
}

} // namespace isotet::io
