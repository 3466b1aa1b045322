// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Grids of a packed file with a field that is made of the points.
#include <algorithm>
#include <mutex>
#include <numeric>
#include <utility>
#include <variant>
#include <vector>

#include <isotet/slice.hpp>

#include "grid/points/slice_function.hpp"
#include "base/parallel.hpp"
#include "io/files/first_error.hpp"
#include "io/packed/boundary_piece.hpp"
#include "io/packed/checks.hpp"
#include "io/packed/file_arrays.hpp"
#include "io/packed/file_residency.hpp"
#include "numbers/value_summary.hpp"
#include "packed/field_storage.hpp"
#include "packed/set_field.hpp"

namespace isotet::io {

namespace {

using core::Packed;

Error slicing_cancelled() { return {ErrorCode::cancelled, "slicing was cancelled"}; }

/// The function of a shape at packed points, as slice_field() gives it at the user's.
class PointValues {
public:
    explicit PointValues(const SliceShape& shape) : shape_(shape) {}

    /// Calls use(point, value) for the packed points [first, last).
    template <class Use>
    void each(const Packed& packed, std::uint64_t first, std::uint64_t last, const Use& use) const {
        std::visit(
            [&](const auto& shape, const auto& reals) {
                const auto function = core::function_of(shape);
                const bool floats = packed.point_type == ScalarType::float32;
                for (std::uint64_t p = first; p < last; ++p) {
                    core::Vector3 place;
                    for (std::size_t axis = 0; axis < 3; ++axis) {
                        const double x = static_cast<double>(reals.positions[3 * p + axis]) + packed.origin[axis];
                        place[axis] = floats ? core::rounded_to_float(x) : x;
                    }
                    use(p, function(place));
                }
            },
            shape_, packed.reals);
    }

    /// Stored values of points. Returns how many became 0 that are not.
    std::uint64_t store(Packed& packed, std::uint64_t first, std::uint64_t last) const {
        std::uint64_t flushed = 0;
        const core::Storage storage = packed.storage;
        std::visit(
            [&]<class Real>(core::Values<Real>& reals) {
                Real* const out = reals.values.data();
                each(packed, first, last, [&](std::uint64_t p, double value) {
                    out[p] = core::store_value<Real>(value, storage);
                    flushed += out[p] == 0 && value != storage.offset;
                });
            },
            packed.reals);
        return flushed;
    }

private:
    const SliceShape shape_;
};

class SlicedResidency final : public core::Residency {
public:
    /// Errors   as slice_field(); as bring()
    static Result<std::shared_ptr<SlicedResidency>> make(std::shared_ptr<FileResidency> grid, const SliceShape& shape,
                                                         const Progress& progress);
    ~SlicedResidency() override { grid_->store()->cache().remove(*values_); }

    const Packed& packed() const { return packed_; }

    Result<core::Brought> bring(std::span<const std::uint32_t> clusters, core::Parts parts, Amount amount,
                                const Progress& progress) const override;
    Result<std::optional<Surface>> boundary() const override { return grid_->boundary(); }
    Result<Array> boundary_values() const override;
    Use use() const override { return grid_->use(); }
    Result<std::shared_ptr<const Packed>> whole(const Progress& progress) const override;

private:
    SlicedResidency(std::shared_ptr<FileResidency> grid, const SliceShape& shape);

    Result<core::ValueSummary> summarize(double offset, const Progress& progress) const;
    Result<void> choose_storage(const std::string& name, const Progress& progress);
    template <class Real>
    Result<void> make_ranges(const Progress& progress);
    ChunkRange range_of(std::size_t chunk) const {
        return chunk_range(grid_->store()->source().directory, grid_->store()->cache().places(), chunk);
    }

    std::shared_ptr<FileResidency> grid_; ///< of any field: its values are not looked at
    SliceShape shape_;
    PointValues point_values_;
    Packed packed_;
    std::unique_ptr<CachedPieces> values_;
    std::vector<std::uint64_t> flushed_; ///< points of each chunk whose value is stored as 0 and is not
};

SlicedResidency::SlicedResidency(std::shared_ptr<FileResidency> grid, const SliceShape& shape)
    : grid_(std::move(grid)), shape_(shape), point_values_(shape), packed_(grid_->packed()) {
    ChunkCache& cache = grid_->store()->cache();
    const ArrayMaker maker(ArrayMaker::As::reserved, cache.places());
    const FieldEntry without_gradients;
    PieceKind kind;
    kind.arrays = make_value_arrays(without_gradients, maker, packed_);
    kind.arrays.resize(1); // group ranges stay in memory: they depend on the points of neighbours, too
    packed_.group_ranges = core::SharedBuffer<core::GroupRange>(cache.places().size(Unit::groups));
    kind.fill = [this](std::size_t chunk) {
        const ChunkRange range = range_of(chunk);
        flushed_[chunk] = point_values_.store(packed_, range.first_point, range.first_point + range.points);
    };
    flushed_.resize(cache.source().directory.chunks.size());
    values_ = std::make_unique<CachedPieces>(std::move(kind), cache.source().directory.chunks.size());
    cache.add(*values_);
}

Result<std::shared_ptr<SlicedResidency>> SlicedResidency::make(std::shared_ptr<FileResidency> grid,
                                                               const SliceShape& shape, const Progress& progress) {
    std::string name;
    const auto checked = std::visit(
        [&](const auto& one) {
            const auto function = core::function_of(one);
            name = function.name();
            return function.check();
        },
        shape);
    if (!checked) return checked.error();
    std::shared_ptr<SlicedResidency> made(new SlicedResidency(std::move(grid), shape));
    if (auto ok = made->choose_storage(name, progress); !ok) return ok.error();
    const Result<void> done =
        made->packed_.single() ? made->make_ranges<float>(progress) : made->make_ranges<double>(progress);
    if (!done) return done.error();
    return made;
}

/// A pass over the points.
Result<core::ValueSummary> SlicedResidency::summarize(double offset, const Progress& progress) const {
    const std::vector<std::uint32_t> clusters = core::all_clusters(packed_);
    core::ValueSummary all;
    std::mutex mutex;
    for (std::size_t first = 0; first < clusters.size();) {
        const auto brought =
            grid_->bring_cells(std::span(clusters).subspan(first), core::Parts::values, Amount::fitting, {}, progress);
        if (!brought) return brought.error();
        core::parallel_each(brought->own.size(), 1, [&](std::size_t i) {
            const ChunkRange range = range_of(brought->own[i]);
            core::ValueSummary some;
            point_values_.each(packed_, range.first_point, range.first_point + range.points,
                               [&](std::uint64_t, double value) { some.add(value, offset); });
            const std::lock_guard lock(mutex);
            all.combine(some);
        });
        if (progress.cancelled()) return slicing_cancelled();
        first += brought->count;
    }
    return all;
}

/// As with_field() chooses it.
Result<void> SlicedResidency::choose_storage(const std::string& name, const Progress& progress) {
    const Precision precision = packed_.single() ? Precision::float32 : Precision::float64;
    auto summary = summarize(0, progress);
    if (!summary) return summary.error();
    core::Storage storage = core::choose_offset(ScalarType::float64, summary->statistics, precision);
    if (storage.offset != 0) {
        summary = summarize(storage.offset, progress);
        if (!summary) return summary.error();
    }
    core::choose_scale(storage, summary->smallest, summary->largest);
    packed_.storage = storage;
    packed_.field = Array(ScalarType::float64, nullptr, 0, 1, nullptr);
    packed_.storage_cache = std::make_shared<core::StorageCache>();
    packed_.gradients = {};
    packed_.report.gradient_bytes = 0;
    FieldReport& report = packed_.field_report;
    report = {};
    report.name = name;
    report.lower = summary->statistics.lower;
    report.upper = summary->statistics.upper;
    report.no_data = summary->statistics.no_data;
    report.infinite = summary->statistics.infinite;
    report.offset = storage.offset;
    report.scale = storage.scale;
    report.unchanged = storage.unchanged;
    return {};
}

/// A pass over all: clusters borrow points of others.
template <class Real>
Result<void> SlicedResidency::make_ranges(const Progress& progress) {
    packed_.as<Real>().ranges = core::SharedBuffer<core::Range<Real>>(packed_.clusters());
    packed_.has_no_data = core::SharedBuffer<std::uint8_t>(packed_.clusters());
    const std::vector<std::uint32_t> clusters = core::all_clusters(packed_);
    for (std::size_t first = 0; first < clusters.size();) {
        const auto brought = bring(std::span(clusters).subspan(first), core::Parts::all, Amount::fitting, progress);
        if (!brought) return brought.error();
        const std::size_t last = first + brought->count;
        core::store_ranges<Real>(packed_, first, last, progress);
        FirstError first_error;
        core::parallel_pieces(last - first, 256, progress, [&](std::size_t begin, std::size_t end) {
            for (std::size_t c = first + begin; c < first + end && !first_error; ++c)
                if (auto ok = check_ranges(packed_, clusters[c]); !ok) first_error.add(c, ok.error());
        });
        if (progress.cancelled()) return slicing_cancelled();
        if (auto ok = first_error.result(); !ok) return grid_->store()->source().in_file(ok.error());
        first = last;
        progress("slice", static_cast<double>(first) / static_cast<double>(clusters.size()));
    }
    packed_.field_report.flushed = std::accumulate(flushed_.begin(), flushed_.end(), std::uint64_t{0});
    return {};
}

Result<core::Brought> SlicedResidency::bring(std::span<const std::uint32_t> clusters, core::Parts parts, Amount amount,
                                             const Progress& progress) const {
    if (clusters.empty()) return core::Brought{};
    CachedPieces* const values = values_.get();
    auto brought = grid_->bring_cells(clusters, parts, amount, {&values, 1}, progress);
    if (!brought) return brought.error();
    if (auto ok = brought->pins->add({&values, 1}, brought->all(), progress); !ok) return ok.error();
    return core::Brought{brought->count, std::move(brought->pins)};
}

Result<Array> SlicedResidency::boundary_values() const {
    const auto boundary = grid_->boundary();
    if (!boundary) return boundary.error();
    auto field = slice_field((*boundary)->positions, shape_);
    if (!field) return field.error();
    const Array& values = field->values;
    return std::visit(
        [&]<class Real>(const core::Values<Real>&) {
            std::vector<Real> stored(values.size());
            for (std::size_t i = 0; i < stored.size(); ++i)
                stored[i] = core::store_value<Real>(values.at(i), packed_.storage);
            return user_values(stored, packed_.field.type(), packed_.storage);
        },
        packed_.reals);
}

Result<std::shared_ptr<const Packed>> SlicedResidency::whole(const Progress& progress) const {
    const auto grid = grid_->whole(progress);
    if (!grid) return grid;
    auto packed = std::make_shared<Packed>(packed_);
    const Packed& of_grid = **grid;
    packed->headers = of_grid.headers;
    packed->cells = of_grid.cells;
    packed->links = of_grid.links;
    packed->point_ids = of_grid.point_ids;
    packed->wide_point_ids = of_grid.wide_point_ids;
    packed->point_ranks = of_grid.point_ranks;
    packed->cell_ids = of_grid.cell_ids;
    packed->wide_cell_ids = of_grid.wide_cell_ids;
    packed->group_ranges = core::SharedBuffer<core::GroupRange>(of_grid.groups());
    packed->has_no_data = core::SharedBuffer<std::uint8_t>(of_grid.clusters());
    std::visit(
        [&]<class Real>(core::Values<Real>& reals) {
            reals.positions = of_grid.as<Real>().positions;
            reals.values = core::SharedBuffer<Real>(of_grid.points());
            reals.ranges = core::SharedBuffer<core::Range<Real>>(of_grid.clusters());
        },
        packed->reals);
    core::parallel_ranges(of_grid.points(), 1 << 14,
                          [&](std::size_t begin, std::size_t end) { point_values_.store(*packed, begin, end); });
    if (packed->single()) core::store_ranges<float>(*packed, 0, packed->clusters(), progress);
    else core::store_ranges<double>(*packed, 0, packed->clusters(), progress);
    if (progress.cancelled()) return slicing_cancelled();
    return std::shared_ptr<const Packed>(std::move(packed));
}

} // namespace

Result<std::shared_ptr<const Packed>> sliced_grid_of_file(const std::shared_ptr<PackedStore>& store,
                                                          const FieldEntry& field, const SliceShape& shape,
                                                          const Progress& progress) {
    auto grid = FileResidency::make(store, field, progress);
    if (!grid) return grid.error();
    auto residency = SlicedResidency::make(*std::move(grid), shape, progress);
    if (!residency) return residency.error();
    auto packed = std::make_shared<Packed>((*residency)->packed());
    packed->residency = *std::move(residency);
    return std::shared_ptr<const Packed>(std::move(packed));
}

} // namespace isotet::io
