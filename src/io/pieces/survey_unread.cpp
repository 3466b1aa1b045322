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
#include "fields/cell_corners_sample.hpp"
#include "grid/fixed_corners.hpp"
#include "grid/patches.hpp"
#include "io/pieces/active_filter.hpp"
#include "io/pieces/join/piece_points.hpp"

namespace isotet::io {
namespace {

/// Keeps the cells that first_view() looks at.
class CellSampler {
public:
    CellSampler(std::optional<CellType> type, std::uint64_t cells) : type_(type), runs_(core::cells_to_sample(cells)) {}

    /// Whole cells from `first` on, as CellTaker::take(). Safe from many threads.
    void add(std::uint64_t first, std::span<const std::uint8_t> types, const Array& corners) {
        const std::uint64_t count =
            types.empty() ? corners.tuples() / core::fixed_corners_of(type_of(types, 0)) : types.size();
        auto run = std::ranges::upper_bound(runs_, first, {}, [](const auto& range) { return range.second; });
        for (; run != runs_.end() && run->first < first + count; ++run) {
            const std::uint64_t begin = std::max(first, run->first), end = std::min(first + count, run->second);
            keep(first, begin, end, types, corners);
        }
    }

    /// The cells in ascending order, and their numbers.
    std::pair<Cells, std::vector<std::uint64_t>> finish() && {
        std::vector<std::uint64_t> numbers, connectivity, offsets{0};
        std::vector<std::uint8_t> types;
        for (const auto& [number, cell] : kept_) {
            numbers.push_back(number);
            types.push_back(cell.type);
            connectivity.insert(connectivity.end(), cell.corners.begin(),
                                cell.corners.begin() + static_cast<std::ptrdiff_t>(core::fixed_corners_of(cell.type)));
            offsets.push_back(connectivity.size());
        }
        Cells cells;
        cells.connectivity = Array::own(std::move(connectivity));
        if (type_) {
            cells.uniform_type = *type_;
        } else {
            cells.types = Array::own(std::move(types));
            cells.offsets = Array::own(std::move(offsets));
        }
        return {std::move(cells), std::move(numbers)};
    }

private:
    struct Cell {
        std::uint8_t type;
        std::array<std::uint64_t, 8> corners;
    };

    std::uint8_t type_of(std::span<const std::uint8_t> types, std::uint64_t i) const {
        return types.empty() ? static_cast<std::uint8_t>(*type_) : types[i];
    }

    void keep(std::uint64_t first, std::uint64_t begin, std::uint64_t end, std::span<const std::uint8_t> types,
              const Array& corners) {
        std::uint64_t at = 0;
        if (types.empty()) at = (begin - first) * core::fixed_corners_of(type_of(types, 0));
        else
            for (std::uint64_t i = 0; i < begin - first; ++i) at += core::fixed_corners_of(types[i]);
        const std::lock_guard lock(mutex_);
        corners.visit([&]<class Index>(std::span<const Index> values) {
            if constexpr (std::is_integral_v<Index>)
                for (std::uint64_t cell = begin; cell < end; ++cell) {
                    Cell& own = kept_[cell];
                    own.type = type_of(types, cell - first);
                    for (std::uint64_t k = 0; k < core::fixed_corners_of(own.type); ++k)
                        own.corners[static_cast<std::size_t>(k)] = core::widened(values[at++]);
                }
        });
    }

    std::optional<CellType> type_; ///< of all
    std::vector<std::pair<std::uint64_t, std::uint64_t>> runs_;
    std::mutex mutex_;
    std::map<std::uint64_t, Cell> kept_;
};

/// Whether the sample has a cell with a volume if any cell has one.
bool has_kinds_of(const GridReport& report, const Cells& sample) {
    if (sample.types.empty()) return true;
    const bool any = std::ranges::any_of(report.cells_by_type,
                                         [](const auto& counted) { return core::has_a_volume(counted.first); });
    return !any || std::ranges::any_of(sample.types.as<std::uint8_t>(), core::has_a_volume);
}

} // namespace

struct CellCounter::Data {
    std::optional<CellType> type;
    core::CellSurvey survey;
    CellSampler sampler;
    std::uint64_t cells;
};

CellCounter::CellCounter(std::unique_ptr<Data> data) : data_(std::move(data)) {}
CellCounter::~CellCounter() = default;

std::unique_ptr<CellCounter> CellCounter::make(const Array& points, std::optional<CellType> type, std::uint64_t cells) {
    if (may_coincide(points, cells)) return nullptr;
    return std::unique_ptr<CellCounter>(
        new CellCounter(std::unique_ptr<Data>(new Data{type, core::CellSurvey(points), {type, cells}, cells})));
}

void CellCounter::take(std::uint64_t first, std::span<const std::uint8_t> types, const Array& corners) {
    if (types.empty()) data_->survey.add(*data_->type, corners);
    else data_->survey.add(types, corners);
    data_->sampler.add(first, types, corners);
}

bool CellCounter::finish(SurveyedGrid& result, const Progress& progress) {
    result.report = data_->survey.finish(progress);
    if (!result.report) return false;
    auto [cells, numbers] = std::move(data_->sampler).finish();
    if (!has_kinds_of(*result.report, cells)) {
        result.report.reset();
        return false;
    }
    result.read.grid.cells = std::move(cells);
    result.read.cells_in_file = data_->cells;
    result.sampled = std::move(numbers);
    return true;
}

bool may_be_counted(const Piece& piece, const ReadOptions& options) {
    if (!piece.unread) return false;
    if (!options.displace.empty() || !options.blocks.empty() || options.patches) return false;
    Piece points;
    points.grid.points = piece.grid.points;
    points.grid.point_fields = piece.grid.point_fields;
    points.point_ids = piece.point_ids;
    if (!check_shape(points)) return false;
    for (const Field& field : piece.grid.cell_fields)
        if (field.values.tuples() != piece.cell_count()) return false;
    const CellPlaces& places = piece.unread->places();
    if (piece.grid.cell_fields.empty()) return true; // else all cells have a volume, those of other pieces too
    return places.are_uniform() ? core::has_a_volume(places.type(0))
                                : std::ranges::all_of(places.types(0, places.cells()), core::has_a_volume);
}

Result<std::optional<SurveyedGrid>> survey_unread(const Piece& piece, const ReadOptions& options,
                                                  const Progress& progress) {
    std::optional<SurveyedGrid> nothing;
    if (piece.cell_count() == 0 || !piece.left_out.empty() || !may_be_counted(piece, options)) return nothing;
    const CellPlaces& places = piece.unread->places();
    std::optional<CellType> type;
    if (places.are_uniform()) type = static_cast<CellType>(places.type(0));
    const auto counter = CellCounter::make(piece.grid.points, type, places.cells());
    if (!counter) return nothing;
    WholeCells whole(places, [&](std::uint64_t first, std::uint64_t count, const Array& corners) {
        if (!progress.cancelled()) counter->take(first, places.types(first, count), corners);
    });
    const auto done =
        piece.unread->each_block([&](std::uint64_t first, const Array& corners) { whole.add(first, corners); });
    if (progress.cancelled()) return Error{ErrorCode::cancelled, "counting cells was cancelled"};
    if (!done && done.error().code == ErrorCode::invalid_data) return nothing; // told when all cells are there
    if (!done) return done.error();
    whole.finish();
    SurveyedGrid result;
    result.read.grid.points = piece.grid.points;
    result.read.grid.point_fields = piece.grid.point_fields;
    result.read.grid.cell_fields = piece.grid.cell_fields;
    if (!counter->finish(result, progress)) return nothing;
    return std::optional(std::move(result));
}

} // namespace isotet::io
