// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/pieces/survey_unread.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <mutex>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include <isotet/grid.hpp>

#include "grid/cell_survey.hpp"
#include "grid/fields/cell_corners_sample.hpp"
#include "grid/fixed_corners.hpp"
#include "grid/patches.hpp"
#include "io/pieces/piece_points.hpp"

namespace isotet::io {
namespace {

/// Keeps the cells that first_view() looks at.
class CellSampler {
public:
    explicit CellSampler(const CellPlaces& places) : places_(places), runs_(core::cells_to_sample(places.cells())) {}

    /// Whole cells from `first` on. Safe from many threads.
    void add(std::uint64_t first, std::uint64_t count, const Array& corners) {
        auto run = std::ranges::upper_bound(runs_, first, {}, [](const auto& range) { return range.second; });
        for (; run != runs_.end() && run->first < first + count; ++run) {
            const std::uint64_t begin = std::max(first, run->first), end = std::min(first + count, run->second);
            keep(begin, end, places_.begin(begin) - places_.begin(first), corners);
        }
    }

    /// The cells in ascending order, and their numbers.
    std::pair<Cells, std::vector<std::uint64_t>> finish() && {
        std::vector<std::uint64_t> numbers, connectivity, offsets{0};
        std::vector<std::uint8_t> types;
        for (const auto& [cell, corners] : kept_) {
            numbers.push_back(cell);
            types.push_back(places_.type(cell));
            connectivity.insert(connectivity.end(), corners.begin(), corners.begin() + count_of(cell));
            offsets.push_back(connectivity.size());
        }
        Cells cells;
        cells.connectivity = Array::own(std::move(connectivity));
        if (places_.are_uniform()) {
            cells.uniform_type = static_cast<CellType>(places_.type(0));
        } else {
            cells.types = Array::own(std::move(types));
            cells.offsets = Array::own(std::move(offsets));
        }
        return {std::move(cells), std::move(numbers)};
    }

private:
    std::ptrdiff_t count_of(std::uint64_t cell) const {
        return static_cast<std::ptrdiff_t>(core::fixed_corners_of(places_.type(cell)));
    }

    void keep(std::uint64_t begin, std::uint64_t end, std::uint64_t at, const Array& corners) {
        const std::lock_guard lock(mutex_);
        corners.visit([&]<class Index>(std::span<const Index> values) {
            if constexpr (std::is_integral_v<Index>)
                for (std::uint64_t cell = begin; cell < end; ++cell) {
                    std::array<std::uint64_t, 8>& own = kept_[cell];
                    for (std::ptrdiff_t k = 0; k < count_of(cell); ++k)
                        own[static_cast<std::size_t>(k)] = core::widened(values[at++]);
                }
        });
    }

    const CellPlaces& places_;
    std::vector<std::pair<std::uint64_t, std::uint64_t>> runs_;
    std::mutex mutex_;
    std::map<std::uint64_t, std::array<std::uint64_t, 8>> kept_;
};

/// Whether the cells may be counted as they go by.
bool may_be_surveyed(const Piece& piece, const ReadOptions& options) {
    if (!piece.unread || piece.cell_count() == 0 || !piece.left_out.empty()) return false;
    if (!options.displace.empty() || !options.blocks.empty() || options.patches) return false;
    Piece points;
    points.grid.points = piece.grid.points;
    points.grid.point_fields = piece.grid.point_fields;
    if (!check_shape(points)) return false;
    for (const Field& field : piece.grid.cell_fields)
        if (field.values.tuples() != piece.cell_count()) return false;
    const CellPlaces& places = piece.unread->places();
    if (!piece.grid.cell_fields.empty() && !places.are_uniform() &&
        !std::ranges::all_of(places.types(0, places.cells()), core::has_a_volume))
        return false;
    return !may_have_coincident_points(piece.grid.points);
}

/// Whether the sample has a cell with a volume if any cell has one.
bool has_kinds_of(const CellPlaces& places, const Cells& sample) {
    if (places.are_uniform()) return true;
    const auto types = sample.types.as<std::uint8_t>();
    return std::ranges::any_of(types, core::has_a_volume) ||
           std::ranges::none_of(places.types(0, places.cells()), core::has_a_volume);
}

} // namespace

Result<std::optional<SurveyedGrid>> survey_unread(const Piece& piece, const ReadOptions& options,
                                                  const Progress& progress) {
    std::optional<SurveyedGrid> nothing;
    if (!may_be_surveyed(piece, options)) return nothing;
    const CellPlaces& places = piece.unread->places();
    core::CellSurvey survey(piece.grid.points);
    CellSampler sampler(places);
    WholeCells whole(places, [&](std::uint64_t first, std::uint64_t count, const Array& corners) {
        if (progress.cancelled()) return;
        if (places.are_uniform()) survey.add(static_cast<CellType>(places.type(0)), corners);
        else survey.add(places.types(first, count), corners);
        sampler.add(first, count, corners);
    });
    const auto done =
        piece.unread->each_block([&](std::uint64_t first, const Array& corners) { whole.add(first, corners); });
    if (progress.cancelled()) return Error{ErrorCode::cancelled, "counting cells was cancelled"};
    if (!done && done.error().code == ErrorCode::invalid_data) return nothing; // told when all cells are there
    if (!done) return done.error();
    whole.finish();
    auto report = survey.finish(progress);
    if (!report) return nothing;
    SurveyedGrid result;
    auto [cells, numbers] = std::move(sampler).finish();
    if (!has_kinds_of(places, cells)) return nothing;
    result.read.grid.points = piece.grid.points;
    result.read.grid.point_fields = piece.grid.point_fields;
    result.read.grid.cell_fields = piece.grid.cell_fields;
    result.read.grid.cells = std::move(cells);
    result.sampled = std::move(numbers);
    result.report = *std::move(report);
    result.read.cells_in_file = places.cells();
    return std::optional(std::move(result));
}

} // namespace isotet::io
