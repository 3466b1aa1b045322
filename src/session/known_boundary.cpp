// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <utility>

#include <isotet/boundary.hpp>

#include "base/guard.hpp"
#include "base/parallel.hpp"
#include "session/marks.hpp"

namespace isotet {

struct KnownBoundary::Data {
    session::CellsMark cells;
    session::ArrayMark points;
    Surface surface;
};

KnownBoundary::KnownBoundary() = default;
KnownBoundary::KnownBoundary(KnownBoundary&&) noexcept = default;
KnownBoundary& KnownBoundary::operator=(KnownBoundary&&) noexcept = default;
KnownBoundary::~KnownBoundary() = default;

Result<Surface> KnownBoundary::of(const Grid& grid, const Run& run) {
    return core::guarded("finding the boundary", [&]() -> Result<Surface> {
        bool is_same = false;
        core::with_threads(run.threads,
                           [&] { is_same = data_ && data_->cells.is(grid) && data_->points.is(grid.points); });
        if (is_same) return data_->surface;
        data_.reset();
        Result<Surface> found = boundary_of(grid, run);
        if (!found) return found;
        core::with_threads(run.threads, [&] {
            data_ = std::make_unique<Data>(
                Data{session::CellsMark(grid), session::ArrayMark(grid.points), *std::move(found)});
        });
        return data_->surface;
    });
}

} // namespace isotet
