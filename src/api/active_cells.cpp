// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/active_cells.hpp>

#include <atomic>
#include <new>
#include <utility>

#include <fmt/format.h>

#include "api/active_cells.hpp"
#include "api/finish.hpp"
#include "base/errors.hpp"
#include "base/system/fresh_memory.hpp"
#include "base/guard.hpp"
#include "cpu/direct/active_filter.hpp"
#include "grid/cells.hpp"

namespace isotet {

Result<void> api::check_active_cells_do(const DirectOptions& options) {
    if (options.frame) return invalid_argument("frames need all cells of a grid");
    return {};
}

struct ActiveCellFilter::Data {
    std::unique_ptr<cpu::ActiveFilter> filter;
    std::atomic<bool> out_of_memory{false};
    bool next_round = false; ///< all cells must be added once more
};

ActiveCellFilter::ActiveCellFilter(std::unique_ptr<Data> data) : data_(std::move(data)) {}
ActiveCellFilter::ActiveCellFilter(ActiveCellFilter&&) noexcept = default;
ActiveCellFilter& ActiveCellFilter::operator=(ActiveCellFilter&&) noexcept = default;
ActiveCellFilter::~ActiveCellFilter() = default;

Result<ActiveCellFilter> ActiveCellFilter::create(const Array& points, const PointField& field,
                                                  std::span<const double> isovalues, std::optional<CellType> type,
                                                  const DirectOptions& options) {
    return core::guarded("looking for active cells", [&]() -> Result<ActiveCellFilter> {
        if (isovalues.empty()) return invalid_argument("active cells are those that isovalues cut, but there is none");
        if (isovalues.size() > max_isovalues)
            return invalid_argument(
                fmt::format("active cells of {} isovalues, but there may be {}", isovalues.size(), max_isovalues));
        if (auto ok = api::check_isovalues(isovalues); !ok) return ok.error();
        const ExtractOptions& extract = options.extract;
        if (auto ok = api::check_active_cells_do(options); !ok) return ok.error();
        Grid grid;
        grid.points = points;
        grid.cells.connectivity = Array(ScalarType::int32, nullptr, 0, 1, nullptr);
        grid.cells.uniform_type = type.value_or(CellType::tetrahedron);
        const auto cells = core::CellReader::open(grid);
        if (!cells) return cells.error();
        if (auto ok = api::check_point_fields(points.tuples(), field, extract.point_fields); !ok) return ok.error();
        const ops::DirectInput input{grid, *cells, field, extract.point_fields, nullptr};
        ops::DirectRequest request;
        request.isovalues = isovalues;
        request.ties = extract.ties;
        request.source_cells = extract.source_cells || !extract.cell_fields.empty();
        request.normals = extract.normals == Normals::gradient;
        auto filter = options.precision == Precision::float32 ? cpu::make_active_filter<float>(input, request, type)
                                                              : cpu::make_active_filter<double>(input, request, type);
        auto data = std::make_unique<Data>();
        data->filter = std::move(filter);
        data->next_round = request.normals;
        return ActiveCellFilter(std::move(data));
    });
}

void ActiveCellFilter::add(std::uint64_t first, const Array& corners) {
    if (!data_) return;
    try {
        data_->filter->add(first, corners);
    } catch (const std::bad_alloc&) {
        data_->out_of_memory = true;
    }
}

void ActiveCellFilter::add_cells(std::uint64_t first_cell, std::span<const std::uint8_t> types, const Array& corners) {
    if (!data_) return;
    try {
        data_->filter->add_cells(first_cell, types, corners);
    } catch (const std::bad_alloc&) {
        data_->out_of_memory = true;
    }
}

bool ActiveCellFilter::next_round() {
    if (!data_ || !std::exchange(data_->next_round, false)) return false;
    try {
        data_->filter->start_second_round();
    } catch (const std::bad_alloc&) {
        data_->out_of_memory = true;
    }
    return true;
}

Result<Cells> ActiveCellFilter::finish() {
    return core::guarded("looking for active cells", [&]() -> Result<Cells> {
        if (!data_) return moved_from("the filter of active cells");
        if (data_->next_round)
            return invalid_argument("gradient normals need cells around those that are cut: all must be added twice");
        if (data_->out_of_memory) return core::ran_out_of_memory("looking for active cells");
        auto cells = data_->filter->finish();
        if (!cells)
            return invalid_data("a cell has a type that is not taken, a point that is not there, or one whose "
                                "coordinates are not finite or 2^91 or more");
        return *std::move(cells);
    });
}

Array ActiveCellFilter::numbers() const { return data_ ? data_->filter->numbers() : Array(); }

} // namespace isotet
