// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <mutex>
#include <optional>
#include <utility>

#include <isotet/linear_cells.hpp>

#include "base/guard.hpp"
#include "base/parallel.hpp"
#include "session/marks.hpp"

namespace isotet {

struct KnownClosing::Data {
    struct Last {
        session::CellsMark cells;
        session::ArrayMark points;
        ClosedGrid closed; ///< without fields
    };

    std::mutex mutex;
    std::optional<Last> last;
};

KnownClosing::KnownClosing() : data_(std::make_unique<Data>()) {}
KnownClosing::~KnownClosing() = default;

Result<ClosedGrid> KnownClosing::of(const Grid& grid, const Run& run) {
    return core::guarded("looking for hanging points", [&]() -> Result<ClosedGrid> {
        const std::lock_guard lock(data_->mutex);
        std::optional<Data::Last>& last = data_->last;
        bool is_same = false;
        core::with_threads(run.threads,
                           [&] { is_same = last && last->cells.is(grid) && last->points.is(grid.points); });
        if (is_same) {
            ClosedGrid closed = last->closed;
            closed.grid = grid;
            if (closed.report.cells > 0) closed.grid.cells = last->closed.grid.cells;
            return closed;
        }
        last.reset();
        Result<ClosedGrid> closed = close_hanging_points(grid, run);
        if (!closed) return closed;
        core::with_threads(run.threads, [&] {
            last.emplace(Data::Last{session::CellsMark(grid), session::ArrayMark(grid.points), *closed});
        });
        if (closed->report.cells == 0) last->closed.grid.cells = {};
        last->closed.grid.points = {};
        last->closed.grid.point_fields = last->closed.grid.cell_fields = {};
        return closed;
    });
}

} // namespace isotet
