// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "grid/boundary_search.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "base/system/memory.hpp"
#include "base/parallel.hpp"
#include "grid/boundary_faces.hpp"
#include "grid/cell_block.hpp"
#include "grid/cell_survey.hpp"
#include "grid/faces.hpp"

namespace isotet::core {

namespace {

Surface surface_of(const Array& all_points, const std::vector<BoundaryFace>& faces) {
    const std::vector<std::uint64_t> points = points_of_faces(faces);
    Surface surface;
    place_vertices(surface, all_points, points);
    surface.triangles = triangles_of_faces(faces, points);
    return surface;
}

/// Of what is free: for kept cells, and for the tables of their faces.
std::uint64_t share_of_memory() {
    constexpr std::uint64_t enough_for_small_grids = 1 << 26;
    return std::max(free_memory() / 4, enough_for_small_grids);
}

} // namespace

BoundarySearch::BoundarySearch(const Array& points)
    : wide_(points.tuples() > std::uint64_t{1} << 32), sums_(points, false), most_kept_(share_of_memory()) {
    block_.points = points;
    points_are_sound_ = all_points_are_sound(block_);
}

BoundarySearch::~BoundarySearch() = default;

void BoundarySearch::add(CellType type, const Array& corners) {
    const Grid block = block_of(block_, type, corners);
    const auto cells = CellReader::open(block);
    if (cells) add(block, *cells, 0, cells->count());
    else broken_ = true;
}

void BoundarySearch::add(std::span<const std::uint8_t> types, const Array& corners) {
    const Grid block = block_of(block_, types, corners);
    const auto cells = CellReader::open(block);
    if (cells) add(block, *cells, 0, cells->count());
    else broken_ = true;
}

void BoundarySearch::add(const Grid& grid, const CellReader& cells, std::size_t begin, std::size_t end) {
    if (all_are_sound(grid, cells, begin, end, points_are_sound_)) sums_.add(cells, begin, end);
    else broken_ = true;
}

bool BoundarySearch::look() {
    sums_.finish();
    if (broken_ || sums_.tets().tets == 0) return false;
    doubted_ = sums_.take_doubted();
    return true;
}

void BoundarySearch::keep(std::uint64_t first, CellType type, const Array& corners) {
    const Grid block = block_of(block_, type, corners);
    const auto cells = CellReader::open(block);
    if (cells) keep(first, *cells, 0, cells->count());
    else broken_ = true;
}

void BoundarySearch::keep(std::uint64_t first, std::span<const std::uint8_t> types, const Array& corners) {
    const Grid block = block_of(block_, types, corners);
    const auto cells = CellReader::open(block);
    if (cells) keep(first, *cells, 0, cells->count());
    else broken_ = true;
}

/// Whether a face of a cell may have a doubted point as its lowest one: of a tet these are the two lowest of all.
template <class Index>
bool BoundarySearch::is_kept(const CellReader& cells, std::size_t cell, std::span<const Index> corners) {
    const std::uint64_t points = doubted_.size();
    std::uint8_t any = 0;
    if (cells.bare_tets()) {
        const auto [a, b] = std::minmax({widened(corners[0]), widened(corners[1])});
        const auto [c, d] = std::minmax({widened(corners[2]), widened(corners[3])});
        if (std::max(b, d) < points)
            return (doubted_[std::min(a, c)] | doubted_[std::min(std::max(a, c), std::min(b, d))]) != 0;
        broken_ = true;
        return false;
    }
    for (const Index corner : corners) {
        if (widened(corner) < points) any |= doubted_[widened(corner)];
        else broken_ = true;
    }
    return any != 0 && is_contoured(cells.type(cell));
}

template <class Index, class Number>
void BoundarySearch::keep_cells(const CellReader& cells, const Index* corners, std::size_t begin, std::size_t end,
                                std::vector<Number>& kept, Run& run) {
    const auto corners_of_cell = [&](std::size_t cell) {
        return std::span(corners + cells.first(cell), cells.corners(cell));
    };
    std::vector<std::size_t> found;
    std::size_t count = 0;
    for (std::size_t cell = begin; cell < end; ++cell) {
        const std::span<const Index> own = corners_of_cell(cell);
        if (!is_kept(cells, cell, own)) continue;
        found.push_back(cell);
        count += own.size();
    }
    kept.reserve(count);
    for (const std::size_t cell : found)
        for (const Index corner : corners_of_cell(cell)) kept.push_back(static_cast<Number>(widened(corner)));
    for (std::size_t i = 0; numbered_ && i < found.size(); ++i) run.numbers.push_back(run.first + (found[i] - begin));
    if (cells.bare_tets()) return;
    run.types.reserve(found.size());
    for (const std::size_t cell : found) run.types.push_back(cells.type(cell));
}

void BoundarySearch::keep(std::uint64_t first, const CellReader& cells, std::size_t begin, std::size_t end) {
    if (!has_kept_all()) return;
    Run run{first, {}, {}, {}};
    cells.connectivity().visit([&](const auto* corners) {
        if (wide_) keep_cells(cells, corners, begin, end, run.wide, run);
        else keep_cells(cells, corners, begin, end, run.narrow, run);
    });
    if (run.corners() == 0) return;
    const std::lock_guard lock(mutex_);
    kept_bytes_ += run.bytes();
    if (has_kept_all()) runs_.push_back(std::move(run));
    else runs_ = {};
}

/// The cells. Types are ordered ones, too, so that cells of several have one each.
FoundBoundary BoundarySearch::join_runs() {
    std::ranges::sort(runs_, {}, &Run::first);
    std::vector<std::size_t> corners{0}, cells{0};
    for (const Run& run : runs_) {
        corners.push_back(corners.back() + run.corners());
        cells.push_back(cells.back() + run.cells());
    }
    FoundBoundary found;
    Cells& joined = found.cells;
    for (const Run& run : runs_) found.numbers.insert(found.numbers.end(), run.numbers.begin(), run.numbers.end());
    const bool typed = std::ranges::any_of(runs_, [](const Run& run) { return !run.types.empty(); });
    const auto join = [&]<class Index>(Buffer<Index> connectivity) {
        Buffer<std::uint8_t> types(typed ? cells.back() : 0);
        Buffer<std::uint64_t> offsets(typed ? cells.back() + 1 : 0);
        if (typed) offsets[cells.back()] = corners.back();
        parallel_each(runs_.size(), 1, [&](std::size_t i) {
            const auto copy = [&](const auto& from) {
                std::ranges::transform(from, connectivity.data() + corners[i],
                                       [](auto point) { return static_cast<Index>(point); });
            };
            const Run run = std::exchange(runs_[i], {});
            copy(run.narrow);
            copy(run.wide);
            std::uint64_t next = corners[i];
            for (std::size_t k = 0; typed && k < run.cells(); ++k) {
                const std::uint8_t type =
                    run.types.empty() ? static_cast<std::uint8_t>(CellType::tetrahedron) : run.types[k];
                types[cells[i] + k] = type;
                offsets[cells[i] + k] = next;
                next += static_cast<std::uint64_t>(corners_of(type));
            }
        });
        joined.connectivity = std::move(connectivity).to_array();
        if (!typed) return;
        joined.types = std::move(types).to_array();
        joined.offsets = std::move(offsets).to_array();
    };
    joined.uniform_type = CellType::tetrahedron;
    if (block_.points.tuples() <= std::uint64_t{1} << 31) join(Buffer<std::int32_t>(corners.back()));
    else join(Buffer<std::int64_t>(corners.back()));
    runs_ = {};
    return found;
}

Result<Surface> BoundarySearch::find(const Grid& grid, const CellReader& cells, const Progress& progress) {
    const auto faces =
        find_boundary_faces_at(std::move(doubted_), grid, cells, sums_.tets(), {.memory = share_of_memory()}, progress);
    if (!faces) return faces.error();
    constexpr std::uint64_t max_numbers = std::numeric_limits<std::uint32_t>::max();
    if (3 * faces->size() > max_numbers && grid.points.tuples() > max_numbers)
        return Error{ErrorCode::invalid_data, fmt::format("the boundary has {} faces, but of a grid of more than 2^32 "
                                                          "points it must have at most {}",
                                                          faces->size(), max_numbers / 3)};
    return surface_of(grid.points, *faces);
}

Result<FoundBoundary> BoundarySearch::finish(const Progress& progress) && {
    if (progress.cancelled()) return Error{ErrorCode::cancelled, "finding the boundary was cancelled"};
    FoundBoundary found = join_runs();
    if (found.cells.connectivity.empty()) {
        found.surface = surface_of(block_.points, {});
        return found;
    }
    Grid grid = block_;
    grid.cells = found.cells;
    const auto cells = CellReader::open(grid);
    if (!cells) return cells.error();
    auto surface = find(grid, *cells, progress);
    if (!surface) return surface.error();
    found.surface = *std::move(surface);
    return found;
}

Result<Surface> BoundarySearch::finish(const Grid& grid, const CellReader& cells, const Progress& progress) && {
    runs_ = {};
    return find(grid, cells, progress);
}

} // namespace isotet::core
