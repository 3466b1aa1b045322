// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// survey() of cells that are never in memory as a whole.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <optional>
#include <span>

#include <isotet/array.hpp>
#include <isotet/export.hpp>
#include <isotet/grid.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>

#include "grid/tet_survey.hpp"
#include "numbers/bounds.hpp"

namespace isotet::core {

/// Linear cells that others are split into, and places of their own.
struct MadeCells {
    static constexpr std::uint64_t made_bit = std::uint64_t{1} << 63;

    std::span<const std::uint8_t> types;
    std::span<const std::uint32_t> counts;  ///< of corners, one each
    std::span<const std::uint64_t> corners; ///< points, or made_bit and the number of a place
    std::span<const Point> places;
};

/// survey_tets() of cells that come by in blocks.
class TetSurveyor {
public:
    explicit TetSurveyor(const Array& points);

    /// Cells [begin, end) of a reader of the same points, which were checked. Safe from many threads.
    void add(const CellReader& cells, std::size_t begin, std::size_t end);
    /// Safe from many threads. Places count as points.
    void add(const MadeCells& cells);

    TetSurvey finish(const Progress& progress) &&;

private:
    PointReader points_;
    TetSurvey survey_;
    Bounds made_; ///< around used places of MadeCells
    std::mutex mutex_;
};

/// survey() of linear cells; others are left out.
Result<GridReport> survey_linear_cells(const Grid& grid, const SurveyOptions& options, const Progress& progress);

/// What survey() tells without faces. `cells`   how many there are
GridReport report_of(const TetSurvey& tets, const Array& points, std::uint64_t cells);

/// What survey() counts without faces, of linear cells that come by in blocks.
///
/// Memory    a byte a point
/// Threads   add() is safe from many threads
class ISOTET_API CellSurvey {
public:
    /// `points`   of the whole grid
    explicit CellSurvey(const Array& points);

    /// Whole cells of a contoured type, by their corners: point numbers of 32 or 64 bits.
    void add(CellType type, const Array& corners);
    /// Of contoured types, vertices, lines, triangles, pixels and quadrilaterals.
    void add(std::span<const std::uint8_t> types, const Array& corners);

    /// When all cells were added. Nothing where survey() would report an error.
    std::optional<GridReport> finish(const Progress& progress);

private:
    void add(const Grid& block);

    Grid block_; ///< points alone
    bool points_are_sound_ = false;
    TetSurveyor tets_;
    std::atomic<std::uint64_t> cells_{0};
    std::atomic<bool> broken_{false};
};

/// Whether the cells [begin, end) have nothing that check_cells() reports. `points_are_sound`   as all_points_are_sound()
bool all_are_sound(const Grid& grid, const CellReader& cells, std::size_t begin, std::size_t end,
                   bool points_are_sound);

} // namespace isotet::core
