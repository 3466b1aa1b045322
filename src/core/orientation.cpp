// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "core/orientation.hpp"

#include <atomic>

#include "core/parallel.hpp"

namespace isotet::core {

bool mostly_negative(const Grid& grid, const CellReader& cells) {
    const PointReader points(grid.points);
    std::atomic<std::int64_t> balance{0};
    parallel_ranges(cells.count(), 1 << 14, [&](std::size_t begin, std::size_t end) {
        std::int64_t sum = 0;
        for (std::size_t cell = begin; cell < end; ++cell) {
            if (cells.type(cell) != static_cast<std::uint8_t>(CellType::tetrahedron)) continue;
            for (const Tet& t : cells.tets(cell)) sum += points.orientation(t);
        }
        balance += sum;
    });
    return balance.load() < 0;
}

} // namespace isotet::core
