// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What the fuzz targets of the grid readers share: an input as one or two files, and what a grid must hold to.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <string_view>
#include <utility>

#include <isotet/read.hpp>

#include "grid/cells.hpp"

namespace isotet::test {

inline std::string_view as_text(const std::uint8_t* data, std::size_t size) {
    return {reinterpret_cast<const char*>(data), size};
}

/// Two files in one input: what stands before and after the first line of five equals signs; without it there is one.
inline std::pair<std::string_view, std::optional<std::string_view>> two_files(std::string_view input) {
    constexpr std::string_view line = "\n=====\n";
    const std::size_t at = input.find(line);
    if (at == std::string_view::npos) return {input, std::nullopt};
    return {input.substr(0, at), input.substr(at + line.size())};
}

/// A grid that comes back has arrays that fit each other, and reads like one.
inline void expect_consistent(const Result<ReadResult>& result) {
    if (!result) {
        if (result.error().message.empty() || result.error().code == ErrorCode::internal) std::abort();
        return;
    }
    const Grid& grid = result->grid;
    const auto cells = core::CellReader::open(grid);
    if (!cells) std::abort();
    for (const Field& field : grid.point_fields) {
        if (field.values.tuples() != grid.points.tuples()) std::abort();
    }
    for (const Field& field : grid.cell_fields) {
        if (field.values.tuples() != grid.cells.count()) std::abort();
    }
    // False for coordinates that are not finite; point numbers must be in range.
    const auto checked = core::check_cells(grid, *cells, {});
    if (!checked && checked.error().message.find("coordinate") == std::string_view::npos) std::abort();
}

/// What was announced without reading is what was read, but for what reading found to be broken.
inline void expect_same_fields(const Result<FileInfo>& announced, const Result<ReadResult>& read) {
    if (!read) return;
    if (!announced || announced->fields.size() < read->info.fields.size()) std::abort();
    if (announced->fields.size() == read->info.fields.size()) return;
    if (read->info.left_out.empty()) std::abort();
}

} // namespace isotet::test
