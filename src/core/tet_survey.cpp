// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "core/tet_survey.hpp"

#include <algorithm>
#include <atomic>

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include "core/bounds.hpp"
#include "core/orientation.hpp"
#include "core/parallel.hpp"

namespace isotet::core {

namespace {

constexpr std::size_t cells_a_chunk = 1 << 14;

struct Partial {
    Bounds bounds;
    std::uint64_t tets = 0, collapsed = 0, left_out = 0;
    std::int64_t balance = 0; ///< upright minus inverted tetrahedra

    void combine(const Partial& other) {
        bounds.combine(other.bounds);
        tets += other.tets;
        collapsed += other.collapsed;
        left_out += other.left_out;
        balance += other.balance;
    }
};

} // namespace

TetSurvey survey_tets(const Grid& grid, const CellReader& cells) {
    const PointReader points(grid.points);
    const Partial total = tbb::parallel_reduce(
        tbb::blocked_range<std::size_t>(0, cells.count(), cells_a_chunk), Partial{},
        [&](const tbb::blocked_range<std::size_t>& range, Partial partial) {
            cells.for_cells(range.begin(), range.end(), [&](std::size_t cell, const CellTets& tets) {
                const std::uint8_t type = cells.type(cell);
                partial.left_out += !is_contoured(type);
                partial.tets += static_cast<std::uint64_t>(tets.count);
                partial.collapsed += static_cast<std::uint64_t>(tets.collapsed);
                for (const Tet& tet : tets) {
                    for (const std::uint64_t corner : tet) partial.bounds.add(points[corner]);
                    if (Orienter::is_whole(type)) partial.balance += points.orientation(tet);
                }
            });
            return partial;
        },
        [](Partial a, const Partial& b) {
            a.combine(b);
            return a;
        });
    TetSurvey survey;
    if (total.tets) {
        survey.lower = total.bounds.lower;
        survey.upper = total.bounds.upper;
    }
    survey.tets = total.tets;
    survey.collapsed = total.collapsed;
    survey.left_out = total.left_out;
    survey.mostly_negative = total.balance < 0;
    return survey;
}

TetCounts count_tets(const CellReader& cells) {
    TetCounts counts;
    counts.used = Buffer<std::uint8_t>(cells.points());
    parallel_ranges(cells.points(), 1 << 18, [&](std::size_t begin, std::size_t end) {
        std::fill_n(counts.used.data() + begin, end - begin, 0);
    });
    std::atomic<std::uint64_t> all_tets{0}, all_collapsed{0}, all_left_out{0};
    parallel_ranges(cells.count(), cells_a_chunk, [&](std::size_t begin, std::size_t end) {
        std::uint64_t tets = 0, collapsed = 0, left_out = 0;
        cells.for_cells(begin, end, [&](std::size_t cell, const CellTets& pieces) {
            tets += static_cast<std::uint64_t>(pieces.count);
            collapsed += static_cast<std::uint64_t>(pieces.collapsed);
            left_out += !cells.only_tets() && !is_contoured(cells.type(cell));
            for (const Tet& tet : pieces)
                for (const std::uint64_t corner : tet)
                    std::atomic_ref<std::uint8_t>(counts.used[corner]).store(1, std::memory_order_relaxed);
        });
        all_tets += tets;
        all_collapsed += collapsed;
        all_left_out += left_out;
    });
    counts.tets = all_tets;
    counts.collapsed = all_collapsed;
    counts.left_out = all_left_out;
    return counts;
}

} // namespace isotet::core
