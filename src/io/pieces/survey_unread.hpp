// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include <isotet/progress.hpp>
#include <isotet/read.hpp>
#include <isotet/result.hpp>

#include "io/pieces/cell_taker.hpp"
#include "io/pieces/loaded.hpp"

namespace isotet::io {

/// What reads for survey_unread(): cells stay in the file, whatever fields there are.
inline ReadOptions to_be_counted(ReadOptions options) {
    options.active_cells.emplace(); // of no isovalue
    return options;
}
inline bool are_counted(const ReadOptions& options) {
    const auto& active = options.active_cells;
    return active && active->isovalues.empty() && active->shares.empty() && !active->choose;
}

/// Counts cells that go by, and keeps a sample of them.
class CellCounter final : public CellTaker {
public:
    /// Nothing where points may coincide.
    /// `points`   of the whole grid;  `type`   of all its cells; nothing: of each its own;  `cells`   their count
    static std::unique_ptr<CellCounter> make(const Array& points, std::optional<CellType> type, std::uint64_t cells);
    ~CellCounter() override;

    void take(std::uint64_t first, std::span<const std::uint8_t> types, const Array& corners) override;

    /// When all cells were taken: the report, sample and its numbers; points and fields are not looked at. False where all cells
    /// are needed.
    bool finish(SurveyedGrid& result, const Progress& progress);

private:
    struct Data;
    explicit CellCounter(std::unique_ptr<Data> data);
    std::unique_ptr<Data> data_;
};

/// Whether the cells of a piece may be counted as they go by, as far as it tells.
bool may_be_counted(const Piece& piece, const ReadOptions& options);

/// Counts the cells of a piece that are not read yet, and keeps a sample of them (read_surveyed()).
///
/// Returns nothing where all cells are needed: cells are left out or broken, points may coincide, there are cell fields beside
/// cells without a volume, or there are options that change points or choose cells
/// Errors       as CellSource; cancelled
/// Cost         one pass over the cells, a byte a point
Result<std::optional<SurveyedGrid>> survey_unread(const Piece& piece, const ReadOptions& options,
                                                  const Progress& progress);

} // namespace isotet::io
