// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "cells_left_out.hpp"

#include <array>
#include <mutex>

#include <fmt/format.h>

#include "core/parallel.hpp"
#include "number_format.hpp"

namespace isotet::cli {

namespace {

using Histogram = std::array<std::uint64_t, 256>;

Histogram count_types(const Array& types) {
    Histogram total{};
    std::mutex mutex;
    const std::span<const std::uint8_t> values = types.as<std::uint8_t>();
    core::parallel_ranges(values.size(), std::size_t{1} << 20, [&](std::size_t begin, std::size_t end) {
        Histogram part{};
        for (const std::uint8_t type : values.subspan(begin, end - begin)) ++part[type];
        const std::lock_guard lock(mutex);
        for (std::size_t i = 0; i < part.size(); ++i) total[i] += part[i];
    });
    return total;
}

} // namespace

std::string cells_left_out_note(const Grid& grid) {
    if (grid.cells.types.type() != ScalarType::uint8 || grid.cells.types.empty()) return {};
    const Histogram counts = count_types(grid.cells.types);
    std::string list;
    for (std::size_t type = 0; type < counts.size(); ++type) {
        const bool contoured = type >= static_cast<std::size_t>(CellType::tetrahedron) &&
                               type <= static_cast<std::size_t>(CellType::pyramid);
        if (counts[type] == 0 || contoured) continue;
        list += fmt::format("{}{} {}", list.empty() ? "" : ", ", grouped(counts[type]),
                            name_of_cell_type(static_cast<std::uint8_t>(type)));
    }
    return list.empty() ? list : "cells left out, their types are not contoured: " + list;
}

} // namespace isotet::cli
