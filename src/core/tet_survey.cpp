// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "core/tet_survey.hpp"

#include <algorithm>
#include <atomic>
#include <mutex>

#include "core/bounds.hpp"
#include "core/orientation.hpp"
#include "core/parallel.hpp"

namespace isotet::core {

namespace {

constexpr std::size_t cells_per_chunk = 1 << 14;

/// Counts of some cells.
struct Partial {
    std::uint64_t tets = 0, collapsed = 0, mirrored = 0;
    std::array<std::uint64_t, 256> by_type{};
    Orienter::Counts orientation;
};

void add_cells(const CellReader& cells, const PointReader& points, std::size_t begin, std::size_t end,
               std::uint8_t* used, Partial& out) {
    const bool typed = !cells.only_tets();
    cells.for_cells(begin, end, [&](std::size_t cell, const CellTets& tets) {
        const std::uint8_t type = cells.type(cell);
        out.by_type[type] += typed;
        out.tets += static_cast<std::uint64_t>(tets.count);
        out.collapsed += static_cast<std::uint64_t>(tets.collapsed);
        const bool whole = Orienter::is_whole(type);
        const bool cell_mirrored = !whole && Orienter::six_volumes(points, tets) < 0;
        for (const Tet& tet : tets) {
            for (const std::uint64_t corner : tet)
                std::atomic_ref<std::uint8_t>(used[corner]).store(1, std::memory_order_relaxed);
            const int sign = points.orientation(tet);
            out.orientation.add(sign, whole, cell_mirrored);
            out.mirrored += sign < 0;
        }
    });
    if (!typed) out.by_type[static_cast<std::uint8_t>(CellType::tetrahedron)] += end - begin;
}

/// Bounds of the used points, and how many are not.
struct UsedPoints {
    Bounds bounds;
    std::uint64_t unused = 0;
};

UsedPoints look_at_used(const PointReader& points, const Buffer<std::uint8_t>& used, const Progress& progress) {
    UsedPoints total;
    std::mutex mutex;
    parallel_pieces(used.size(), 1 << 16, progress, [&](std::size_t begin, std::size_t end) {
        UsedPoints part;
        for (std::size_t i = begin; i < end; ++i) {
            part.unused += !used[i];
            if (used[i]) part.bounds.add(points[i]);
        }
        const std::lock_guard lock(mutex);
        total.bounds.combine(part.bounds);
        total.unused += part.unused;
    });
    return total;
}

void clear(Buffer<std::uint8_t>& flags) {
    parallel_ranges(flags.size(), 1 << 18,
                    [&](std::size_t begin, std::size_t end) { std::fill_n(flags.data() + begin, end - begin, 0); });
}

} // namespace

TetSurvey survey_tets(const Grid& grid, const CellReader& cells, const Progress& progress) {
    const PointReader points(grid.points);
    TetSurvey survey;
    survey.used = Buffer<std::uint8_t>(cells.points());
    clear(survey.used);
    std::mutex mutex;
    parallel_pieces(cells.count(), cells_per_chunk, progress, [&](std::size_t begin, std::size_t end) {
        Partial part;
        add_cells(cells, points, begin, end, survey.used.data(), part);
        const std::lock_guard lock(mutex);
        survey.tets += part.tets;
        survey.collapsed += part.collapsed;
        survey.mirrored += part.mirrored;
        survey.orientation.combine(part.orientation);
        for (std::size_t type = 0; type < part.by_type.size(); ++type) survey.cells_by_type[type] += part.by_type[type];
    });
    for (std::size_t type = 0; type < survey.cells_by_type.size(); ++type)
        if (!is_contoured(static_cast<std::uint8_t>(type))) survey.left_out += survey.cells_by_type[type];
    const UsedPoints of_used = look_at_used(points, survey.used, progress);
    survey.unused = of_used.unused;
    if (survey.tets) {
        survey.lower = of_used.bounds.lower;
        survey.upper = of_used.bounds.upper;
    }
    return survey;
}

TetCounts count_tets(const CellReader& cells) {
    TetCounts counts;
    counts.used = Buffer<std::uint8_t>(cells.points());
    clear(counts.used);
    std::atomic<std::uint64_t> all_tets{0}, all_collapsed{0}, all_left_out{0};
    parallel_ranges(cells.count(), cells_per_chunk, [&](std::size_t begin, std::size_t end) {
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
