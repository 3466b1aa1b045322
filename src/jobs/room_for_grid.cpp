// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "jobs/room_for_grid.hpp"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <isotet/text.hpp>

#include "base/system/block.hpp"
#include "base/system/fresh_memory.hpp"
#include "base/system/scratch_memory.hpp"

namespace isotet::jobs {

namespace {

bool is_named(const std::optional<std::vector<std::string>>& names, const FieldInfo& field) {
    return !names || std::ranges::find(*names, field.name) != names->end();
}

/// Blocks of memory that are kept for the next ones are free, too.
std::uint64_t all_that_is_free(std::uint64_t needed) {
    const std::uint64_t free = core::free_memory_and_swap();
    return needed > free && core::drop_kept_blocks() > 0 ? core::free_memory_and_swap() : free;
}

/// 2^48 where it is more, as a broken head may ask for.
std::uint64_t product(std::uint64_t count, std::uint64_t bytes) {
    constexpr std::uint64_t most = std::uint64_t{1} << 48;
    return bytes > 0 && count > most / bytes ? most : count * bytes;
}

} // namespace

GridBytes least_bytes_of(const FileInfo& info, const FieldsToRead& fields, bool all_cells) {
    constexpr std::uint64_t a_corner = 4; // as int32
    const LeastCounts& least = info.least;
    const bool has_cells = all_cells || least.all_cells;
    GridBytes bytes;
    bytes.points = product(least.points, 3 * size_of(least.coordinates));
    if (has_cells) bytes.cells = product(std::max(least.corners, least.cells), a_corner);
    const bool of_other_meshes = info.format == "med" || info.format == "cgns"; // have fields, which are told of, too
    if (info.times.size() > 1 || of_other_meshes) return bytes;                 // a step may lack fields
    for (const FieldInfo& field : info.fields) {
        const bool of_points = field.association == Association::point;
        if (!is_named(of_points ? fields.point : fields.cell, field) || (!of_points && !has_cells)) continue;
        bytes.values += product(of_points ? least.points : least.cells, field.components * size_of(field.type));
    }
    return bytes;
}

Result<void> require_room(const std::string& file, const GridBytes& grid, const BesideGrid& beside,
                          std::uint64_t points) {
    const std::vector<std::pair<std::uint64_t, std::string_view>> parts{
        {grid.points, "points"},
        {grid.cells, "cells"},
        {grid.values, "values of fields"},
        {product(points, beside.bytes_a_point), beside.what}};
    std::uint64_t all = 0;
    std::vector<std::string> list;
    for (const auto& [bytes, what] : parts) {
        all += bytes;
        if (bytes > 0) list.push_back(fmt::format("{} for {}", format_bytes(bytes), what));
    }
    const std::string what = "reading " + file;
    if (auto there = core::require_scratch(what, all)) return *std::move(there);
    const std::uint64_t free = all_that_is_free(all);
    if (all <= free) return {};
    return Error{ErrorCode::out_of_memory, fmt::format("{} needs {} at least, {}, but {} are free", what,
                                                       format_bytes(all), fmt::join(list, ", "), format_bytes(free))};
}

} // namespace isotet::jobs
