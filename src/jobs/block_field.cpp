// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "jobs/block_field.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <set>
#include <string>
#include <utility>

#include <fmt/format.h>

#include <isotet/jobs/number_text.hpp>

namespace isotet::jobs {

namespace {

std::uint64_t cells_of(const std::vector<BlockInfo>& blocks) {
    std::uint64_t cells = 0;
    for (const BlockInfo& block : blocks) cells += block.cells;
    return cells;
}

} // namespace

bool has_block_field(const FileInfo& info) {
    const auto is_named_so = [](const FieldInfo& field) {
        return field.association == Association::cell && field.name == block_field_name;
    };
    constexpr std::array<std::string_view, 5> formats{"exodus", "cgns", "ensight", "vtm", "vtpc"};
    if (std::ranges::find(formats, info.format) == formats.end()) return false;
    if (info.format == "exodus" && info.files.size() > 1) return false; // its parts
    std::set<std::int64_t> numbers;
    for (const BlockInfo& block : info.blocks) {
        if (block.kind == "element set") return false;
        numbers.insert(block.number);
    }
    return info.blocks.size() > 1 && numbers.size() == info.blocks.size() && info.cells > 0 &&
           cells_of(info.blocks) == info.cells && std::ranges::none_of(info.fields, is_named_so);
}

std::vector<RegionName> names_of_blocks(const FileInfo& info) {
    std::vector<RegionName> names;
    for (const BlockInfo& block : info.blocks)
        if (!block.name.empty()) names.push_back({std::string(block_field_name), block.number, block.name});
    return names;
}

Result<void> add_block_field(Grid& grid, const std::vector<BlockInfo>& blocks) {
    const std::uint64_t cells = cells_of(blocks);
    if (cells != grid.cells.count())
        return Error{ErrorCode::invalid_data,
                     fmt::format("the blocks have {}, but {} were read: it is not known which cell is of which block",
                                 counted(cells, "cell"), grouped(grid.cells.count()))};
    std::vector<std::int64_t> numbers;
    numbers.reserve(grid.cells.count());
    for (const BlockInfo& block : blocks) numbers.insert(numbers.end(), block.cells, block.number);
    grid.cell_fields.push_back({std::string(block_field_name), Array::own(std::move(numbers))});
    return {};
}

} // namespace isotet::jobs
