// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "grid/tet_survey.hpp"

#include <algorithm>
#include <atomic>
#include <mutex>

#include "base/parallel.hpp"
#include "grid/cell/native_cells.hpp"
#include "grid/orientation.hpp"
#include "numbers/bounds.hpp"

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
        const bool whole = Orienter::is_whole(type), ordered = is_ordered(type);
        const bool cell_mirrored = !whole && Orienter::six_volumes(points, tets) < 0;
        for (const Tet& tet : tets) {
            for (const std::uint64_t corner : tet)
                std::atomic_ref<std::uint8_t>(used[corner]).store(1, std::memory_order_relaxed);
            const int sign = points.orientation(tet);
            if (ordered) {
                out.orientation.add_ordered(sign);
                continue;
            }
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

namespace {

/// `count_range(begin, end, counts, mark)` adds to counts, and calls mark(corner) for the corners of what is stored.
template <class CountRange>
CellCounts count_all(const CellReader& cells, const CountRange& count_range) {
    CellCounts total;
    total.used = Buffer<std::uint8_t>(cells.points());
    clear(total.used);
    std::mutex mutex;
    parallel_ranges(cells.count(), cells_per_chunk, [&](std::size_t begin, std::size_t end) {
        CellCounts part;
        count_range(begin, end, part, [&](std::uint64_t corner) {
            std::atomic_ref<std::uint8_t>(total.used[corner]).store(1, std::memory_order_relaxed);
        });
        const std::lock_guard lock(mutex);
        total.stored += part.stored;
        total.collapsed += part.collapsed;
        total.left_out += part.left_out;
        total.split += part.split;
    });
    return total;
}

} // namespace

CellCounts count_tets(const CellReader& cells) {
    return count_all(cells, [&](std::size_t begin, std::size_t end, CellCounts& counts, const auto& mark) {
        cells.for_cells(begin, end, [&](std::size_t cell, const CellTets& pieces) {
            counts.stored += static_cast<std::uint64_t>(pieces.count);
            counts.collapsed += static_cast<std::uint64_t>(pieces.collapsed);
            counts.left_out += !cells.only_tets() && !is_contoured(cells.type(cell));
            for (const Tet& tet : pieces)
                for (const std::uint64_t corner : tet) mark(corner);
        });
    });
}

CellCounts count_native_cells(const CellReader& cells) {
    return count_all(cells, [&](std::size_t begin, std::size_t end, CellCounts& counts, const auto& mark) {
        for (std::size_t cell = begin; cell < end; ++cell) {
            if (!is_contoured(cells.type(cell))) {
                ++counts.left_out;
                continue;
            }
            const NativeParts parts = native_parts(cells.whole(cell));
            counts.stored += static_cast<std::uint64_t>(parts.count);
            counts.collapsed += static_cast<std::uint64_t>(parts.collapsed);
            counts.split += parts.is_split;
            for (const WholeCell& part : parts)
                for (std::size_t k = 0; k < corner_count(part.kind); ++k) mark(part.corners[k]);
        }
    });
}

} // namespace isotet::core
