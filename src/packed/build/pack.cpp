// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/pack.hpp>

#include <atomic>
#include <optional>
#include <type_traits>

#include <fmt/core.h>

#include "base/system/block_reuse.hpp"
#include "base/carry_out.hpp"
#include "base/system/memory.hpp"
#include "base/parallel.hpp"
#include "base/workers.hpp"
#include "grid/cell/native_cells.hpp"
#include "grid/orientation.hpp"
#include "grid/renumber.hpp"
#include "packed/build/pack_draft.hpp"
#include "packed/field_storage.hpp"
#include "packed/frame.hpp"
#include "packed/residency.hpp"
#include "packed/stored_cells.hpp"

namespace isotet {

namespace core {

Result<void> check_field(const PointField& field, std::uint64_t points) {
    if (field.values.components() != 1 && !field.values.empty())
        return Error{ErrorCode::invalid_argument,
                     fmt::format("field '{}' has {} components, but the contoured field must have 1", field.name,
                                 field.values.components())};
    if (field.values.tuples() != points)
        return Error{ErrorCode::invalid_argument, fmt::format("field '{}' has {} values, but the grid has {} points",
                                                              field.name, field.values.tuples(), points)};
    return {};
}

namespace {

/// At the peak, while clusters are grown: the sorted cells (16 B a tet, 32 a native cell, some pages half empty) and what
/// is grown so far; before, as points are sorted, or later, as seams are found, about as much. And what each thread
/// needs for the bucket and the block at hand.
template <class Item>
std::uint64_t packing_memory(std::uint64_t cells, const Grid& grid, bool origins) {
    constexpr std::uint64_t a_thread = 500'000, a_block = sizeof(Item) == sizeof(RankedTet) ? 3'000'000 : 5'000'000;
    const std::uint64_t a_point = grid.points.type() == ScalarType::float32 ? 38 : 50;
    const std::uint64_t a_cell = sizeof(Item) == sizeof(RankedTet) ? 22 : 50;
    return (origins ? a_cell + 8 : a_cell) * cells + a_point * grid.points.tuples() +
           a_thread * static_cast<std::uint64_t>(threads_here()) + a_block * blocks_at_once(cells);
}

void measure(Packed& packed) {
    PackReport& report = packed.report;
    report.points = packed.points();
    report.bytes = packed.headers.bytes() + packed.cells.bytes() + packed.group_ranges.bytes() + packed.links.bytes() +
                   packed.has_no_data.bytes() + packed.point_ids.bytes() + packed.wide_point_ids.bytes() +
                   packed.point_ranks.bytes();
    std::visit(
        [&](const auto& reals) {
            report.bytes += reals.positions.bytes() + reals.values.bytes() + reals.ranges.bytes();
        },
        packed.reals);
    report.source_bytes = packed.cell_ids.bytes() + packed.wide_cell_ids.bytes();
}

template <class Real>
Result<void> store_field(const PointField& field, Packed& packed, const Progress& progress) {
    if (auto ok = store_values<Real>(field, packed, progress); !ok) return ok;
    store_ranges<Real>(packed, 0, packed.clusters(), progress);
    if (progress.cancelled()) return Error{ErrorCode::cancelled, "storing the field was cancelled"};
    return {};
}

Result<void> store_field(const PointField& field, Packed& packed, const Progress& progress) {
    return packed.single() ? store_field<float>(field, packed, progress) : store_field<double>(field, packed, progress);
}

Result<void> store_points(const Array& points, Packed& packed) {
    return packed.single() ? store_positions<float>(points, packed) : store_positions<double>(points, packed);
}

/// From points sorted by their numbers back to the user's.
void restore_point_ids(const Buffer<std::uint64_t>& original, bool keep_ranks, Packed& packed) {
    if (keep_ranks) packed.point_ranks = SharedBuffer<std::uint64_t>(packed.points());
    const auto restore = [&](auto& ids) {
        using Id = std::remove_reference_t<decltype(ids[0])>;
        worker_each(ids.size(), 1 << 16, [&](std::size_t i) {
            if (keep_ranks) packed.point_ranks[i] = ids[i];
            ids[i] = static_cast<Id>(original[ids[i]]);
        });
    };
    restore(packed.point_ids);
    restore(packed.wide_point_ids);
}

/// From counted cells to clusters with their points numbered.
template <class Item>
Result<void> gather(const Grid& grid, const CellReader& cells, CellCounts counts, const PackOptions& options,
                    Draft& draft, const Progress& progress) {
    const bool origins = options.source_cells || !cells.only_tets();
    if (auto ok = require_memory("packing the grid", packing_memory<Item>(counts.stored, grid, origins)); !ok)
        return ok.error();
    std::optional<bool> mostly_negative;
    if (options.frame) mostly_negative = is_mostly_negative(*options.frame);
    auto order = sort_cells<Item>(grid, cells, std::move(counts), {options.source_cells, mostly_negative}, progress);
    if (!order) return order.error();
    if (auto ok = form_clusters(*std::move(order), cells.count(), draft, progress); !ok) return ok.error();
    number_points(grid.points.tuples(), draft);
    return {};
}

Result<std::shared_ptr<const Packed>> pack(const Grid& grid, const PointField& field, const PackOptions& options,
                                           const Progress& progress) {
    auto cells = CellReader::open(grid);
    if (!cells) return cells.error();
    if (auto ok = check_field(field, grid.points.tuples()); !ok) return ok.error();
    if (auto ok = check_cells(grid, *cells, progress); !ok) return ok.error();
    if (auto ok = find_in_frame(options.frame, field.name, field.values.type()); !ok) return ok.error();
    std::optional<Renumbered> sorted;
    if (!grid.point_numbers.empty()) {
        auto by_number = sort_points_by_number(grid);
        if (!by_number) return by_number.error();
        sorted = *std::move(by_number);
        cells = CellReader::open(sorted->grid);
        if (!cells) return cells.error();
    }
    const Grid& numbered = sorted ? sorted->grid : grid;
    const bool native = !cells->only_tets() && !options.split_cells;
    CellCounts counts = native ? count_native_cells(*cells) : count_tets(*cells);
    if (counts.stored == 0 && !options.frame) return nothing_to_contour(grid, *cells); // a piece may be empty

    const BlockReuse reuse;
    const std::uint64_t left_out = counts.left_out, collapsed = counts.collapsed, split = counts.split;
    Draft draft;
    if (options.precision == Precision::float64) draft.packed.reals = Values<double>{};
    if (counts.stored > 0) {
        const auto gathered = native ? gather<RankedCell>(numbered, *cells, std::move(counts), options, draft, progress)
                                     : gather<RankedTet>(numbered, *cells, std::move(counts), options, draft, progress);
        if (!gathered) return gathered.error();
        progress("pack", 0.7);
        if (auto ok = link_clusters(draft, progress); !ok) return ok.error();
    }
    draft.locals.release();
    draft.point_of.release();

    auto packed = std::make_shared<Packed>(std::move(draft.packed));
    packed->storage_cache = std::make_shared<StorageCache>();
    packed->user_points = grid.points.tuples();
    packed->user_cells = cells->count();
    packed->report.cells_left_out = left_out;
    packed->report.collapsed_tets = collapsed;
    packed->report.split_cells = split;
    packed->frame = options.frame;
    if (sorted) restore_point_ids(sorted->original, native, *packed);
    sorted.reset();
    if (auto ok = store_points(grid.points, *packed); !ok) return ok.error();
    if (auto ok = store_field(field, *packed, progress); !ok) return ok.error();
    if (options.gradients) store_gradients(*packed);
    measure(*packed);
    progress("pack", 1);
    return std::shared_ptr<const Packed>(std::move(packed));
}

/// True when no stored tet has a negative volume with these coordinates, and no other cell would be stored inside out.
Result<void> check_moved_points(const Packed& packed, const Array& points) {
    const PointReader reader(points);
    std::atomic<std::uint64_t> outside{0}, turned{0};
    worker_each(packed.clusters(), 64, [&](std::size_t c) {
        std::uint64_t locals[max_cluster_points];
        Point positions[max_cluster_points];
        const std::size_t count = local_points(packed, c, locals);
        for (std::size_t k = 0; k < count; ++k) {
            positions[k] = reader[packed.user_point(locals[k])];
            for (const double x : positions[k]) outside += !(std::abs(x) < 0x1p91);
        }
        for (const StoredTet& tet : packed.cluster_tets(c)) {
            const auto& v = tet.corners;
            turned += orientation_sign(positions[v[0]], positions[v[1]], positions[v[2]], positions[v[3]]) < 0;
        }
        packed.for_other_cells(c, [&](const StoredCell& cell) {
            const WholeCell ranked = ranked_cell(packed, locals, cell);
            turned += turn_of(ranked, [&](std::size_t k) { return positions[cell.corners[k]]; }).is_mirrored();
        });
    });
    if (outside)
        return Error{ErrorCode::invalid_data,
                     fmt::format("{} of the new coordinates are not finite or 2^91 or more, but "
                                 "points that cells use must be finite and below 2^91",
                                 outside)};
    if (turned)
        return Error{
            ErrorCode::invalid_data,
            fmt::format("{} cells change their orientation with the new points, and such a grid must be packed again",
                        turned)};
    return {};
}

} // namespace
} // namespace core

PackedGrid::PackedGrid() {
    static const auto empty = std::make_shared<const core::Packed>();
    data_ = empty;
}
PackedGrid::PackedGrid(std::shared_ptr<const core::Packed> data) : data_(std::move(data)) {}

const PackReport& PackedGrid::report() const noexcept { return data_->report; }
const FieldReport& PackedGrid::field() const noexcept { return data_->field_report; }
Precision PackedGrid::precision() const noexcept { return data_->single() ? Precision::float32 : Precision::float64; }
std::uint64_t PackedGrid::user_point_count() const noexcept { return data_->user_points; }
std::uint64_t PackedGrid::user_cell_count() const noexcept { return data_->user_cells; }

const Frame* PackedGrid::frame() const noexcept { return data_->frame ? &*data_->frame : nullptr; }

PackedGrid PackedGrid::with_frame(const std::optional<Frame>& frame) const {
    const auto next = std::make_shared<core::Packed>(*data_);
    next->frame = frame;
    next->storage_cache = std::make_shared<core::StorageCache>();
    return PackedGrid(next);
}

Result<PackedGrid> PackedGrid::with_field(const PointField& field, const Run& run) const {
    return core::carry_out("setting the field", run, [&](const Progress& progress) -> Result<PackedGrid> {
        if (auto ok = core::check_field(field, data_->user_points); !ok) return ok.error();
        const auto whole = core::whole_of(data_, progress);
        if (!whole) return whole.error();
        const auto next = std::make_shared<core::Packed>(**whole);
        if (auto stored = core::store_field(field, *next, progress); !stored) return stored.error();
        if (!next->gradients.empty()) core::store_gradients(*next);
        return PackedGrid(next);
    });
}

Result<PackedGrid> PackedGrid::with_points(const Array& points, const Run& run) const {
    return core::carry_out("setting the points", run, [&](const Progress& progress) -> Result<PackedGrid> {
        if (!is_floating(points.type()) || points.components() != 3 || points.tuples() != data_->user_points)
            return Error{ErrorCode::invalid_argument,
                         fmt::format("the new points are {} x {} {}, but must be {} x 3 of float32 or float64",
                                     points.tuples(), points.components(), name_of(points.type()), data_->user_points)};
        const auto whole = core::whole_of(data_, progress);
        if (!whole) return whole.error();
        const auto next = std::make_shared<core::Packed>(**whole);
        if (auto checked = core::check_moved_points(*next, points); !checked) return checked.error();
        if (auto stored = core::store_points(points, *next); !stored) return stored.error();
        if (!next->gradients.empty()) core::store_gradients(*next);
        progress("pack", 1);
        return PackedGrid(next);
    });
}

Result<PackedGrid> pack(const Grid& grid, const PointField& field, const PackOptions& options, const Run& run) {
    return core::carry_out("packing", run, [&](const Progress& progress) -> Result<PackedGrid> {
        Result<std::shared_ptr<const core::Packed>> result = core::pack(grid, field, options, progress);
        if (!result) return std::move(result).error();
        return PackedGrid(*std::move(result));
    });
}

} // namespace isotet
