// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/pieces/boundary_pass.hpp"

#include <utility>

#include <isotet/active_cells.hpp>

#include "base/system/memory.hpp"
#include "base/parallel.hpp"

namespace isotet::io {

Result<bool> take_boundary(core::BoundarySearch&& search, const Array& points, StreamedBoundary& boundary,
                           const Progress& progress) {
    if (!search.has_kept_all()) return false;
    boundary.cells = {};
    auto found = std::move(search).finish(progress);
    if (!found) return found.error();
    if (found->cells.count() > 0) {
        const Run run{.progress = {nullptr, progress.cancel}};
        Grid around{points, std::move(found->cells), {}, {}};
        const Result<bool> hang = has_hanging_points(around, found->surface, run);
        if (!hang) return hang.error();
        if (*hang) return false;
        if (boundary.wants_cells) boundary.cells = std::move(around);
    }
    boundary.numbers = std::move(found->numbers);
    boundary.surface = std::move(found->surface);
    boundary.is_there = true;
    return true;
}

Result<void> BoundaryPass::check_memory(const Array& points) {
    return core::require_memory("finding the boundary", core::BoundarySearch::bytes(points.tuples()));
}

BoundaryPass::BoundaryPass(StreamedBoundary& boundary, const Array& points, const CellSource& cells)
    : boundary_(boundary),
      points_(points),
      cells_(cells),
      whole_(cells.places(), [this](std::uint64_t first, std::uint64_t count, const Array& corners) {
          BoundaryTaker(*search_, type(), BoundaryTaker::Round::add)
              .take(first, cells_.places().types(first, count), corners);
      }) {
    if (boundary.of_steps) print_.emplace();
    if (!boundary.is_there) begin_search();
}

void BoundaryPass::begin_search() {
    search_.emplace(points_);
    if (boundary_.wants_cells) search_->keep_numbers();
}

std::optional<CellType> BoundaryPass::type() const {
    const CellPlaces& places = cells_.places();
    return places.are_uniform() ? std::optional(static_cast<CellType>(places.type(0))) : std::nullopt;
}

void BoundaryPass::add(std::uint64_t first, const Array& corners) {
    if (print_) print_->add(first, corners);
    if (search_) whole_.add(first, corners);
}

Result<void> BoundaryPass::each_cells(BoundaryTaker::Round round, const Progress& progress) {
    BoundaryTaker taker(*search_, type(), round);
    WholeCells whole(cells_.places(), [&](std::uint64_t first, std::uint64_t count, const Array& corners) {
        taker.take(first, cells_.places().types(first, count), corners);
    });
    const auto done = cells_.each_block([&](std::uint64_t first, const Array& corners) {
        if (!progress.cancelled()) whole.add(first, corners);
    });
    if (progress.cancelled()) return Error{ErrorCode::cancelled, "finding the boundary was cancelled"};
    if (done) whole.finish();
    return done;
}

Result<bool> BoundaryPass::search(const Progress& progress) {
    if (!search_->look()) return false;
    if (auto done = each_cells(BoundaryTaker::Round::keep, progress); !done) return done.error();
    return take_boundary(*std::move(search_), points_, boundary_, progress);
}

Result<bool> BoundaryPass::finish(const Progress& progress) {
    if (progress.cancelled()) return Error{ErrorCode::cancelled, "finding the boundary was cancelled"};
    whole_.finish();
    if (print_) {
        const CellPlaces& places = cells_.places();
        const auto print = print_->finish(points_, places.types(0, places.cells()), places.type(0), places.cells());
        if (boundary_.is_there && print == boundary_.print) return true;
        boundary_.print = print;
    }
    boundary_.is_there = false;
    if (!search_) {
        begin_search();
        if (auto done = each_cells(BoundaryTaker::Round::add, progress); !done) return done.error();
    }
    return search(progress);
}

} // namespace isotet::io
