// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Grids between two steps of a packed file.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <variant>
#include <vector>

#include "base/buffer.hpp"
#include "base/parallel.hpp"
#include "io/packed/boundary_piece.hpp"
#include "io/packed/checks.hpp"
#include "io/packed/file_arrays.hpp"
#include "io/packed/file_residency.hpp"
#include "numbers/normal_code.hpp"
#include "numbers/storage.hpp"
#include "packed/field_storage.hpp"
#include "packed/set_field.hpp"

namespace isotet::io {

namespace {

using core::Packed;
using core::Storage;

/// (1 - w) a + w b of stored numbers, each product and the sum rounded once. Where the two are scaled otherwise, both are
/// brought to the smaller scale first, which is exact but for what becomes too small to be stored.
template <class Real>
class Blend {
public:
    Blend(double fraction, double scale_a = 1, double scale_b = 1)
        : a_(Real(1) - static_cast<Real>(fraction)),
          b_(static_cast<Real>(fraction)),
          rescale_a_(static_cast<Real>(std::min(scale_a, scale_b) / scale_a)),
          rescale_b_(static_cast<Real>(std::min(scale_a, scale_b) / scale_b)) {}

    Real operator()(Real a, Real b) const {
        constexpr Real infinity = static_cast<Real>(core::stored_infinity);
        if (core::is_nan(a) || core::is_nan(b)) return core::canonical_nan<Real>();
        const bool a_is_infinite = std::abs(a) >= infinity, b_is_infinite = std::abs(b) >= infinity;
        if (a_is_infinite && b_is_infinite) return a == b ? a : core::canonical_nan<Real>();
        if (a_is_infinite) return a;
        if (b_is_infinite) return b;
        return stored(a_ * (a * rescale_a_), b_ * (b * rescale_b_));
    }

    /// Of coordinates, which are all finite.
    Real coordinate(Real a, Real b) const { return stored(a_ * a, b_ * b); }

    /// Holds what values within the two blend to: roundings may leave the union of both by a few units in the last place,
    /// and what becomes too small to be stored is 0.
    core::Range<Real> range(core::Range<Real> a, core::Range<Real> b) const {
        if (a.lower > a.upper || b.lower > b.upper) // no value has data
            return {std::numeric_limits<Real>::max(), std::numeric_limits<Real>::lowest()};
        const Real lower = std::min(rescaled_a(a.lower), rescaled_b(b.lower));
        const Real upper = std::max(rescaled_a(a.upper), rescaled_b(b.upper));
        const Real margin =
            std::max({std::abs(lower), std::abs(upper), Real(core::tiny)}) * 4 * std::numeric_limits<Real>::epsilon();
        core::Range<Real> both{lower - margin, upper + margin};
        if (0 < both.lower && both.lower < Real(core::tiny)) both.lower = 0;
        if (-Real(core::tiny) < both.upper && both.upper < 0) both.upper = 0;
        return both;
    }

private:
    static Real stored(Real of_a, Real of_b) {
        const Real sum = of_a + of_b;
        return std::abs(sum) < Real(core::tiny) ? Real(0) : sum;
    }
    Real rescaled_a(Real a) const { return rescaled(a, rescale_a_); }
    Real rescaled_b(Real b) const { return rescaled(b, rescale_b_); }
    static Real rescaled(Real value, Real scale) {
        return std::abs(value) >= static_cast<Real>(core::stored_infinity) ? value : value * scale;
    }

    Real a_, b_, rescale_a_, rescale_b_;
};

/// Values that a step of quantize() may stand for, widened by a step.
template <class Real>
core::Range<Real> values_of(core::GroupRange group, core::Range<Real> range) {
    const Real factor = core::quantize_factor(range);
    if (factor == 0) return range;
    const Real step = 1 / factor;
    return {range.lower + (static_cast<Real>(group.lower) - 1) * step,
            group.upper == 255 ? range.upper
                               : std::min(range.upper, range.lower + (static_cast<Real>(group.upper) + 2) * step)};
}

/// The stored field of `from` becomes that between both.
void set_storage(const Packed& from, const Packed& to, double fraction, Packed& packed) {
    const Storage &a = from.storage, &b = to.storage;
    const bool unchanged = a.unchanged && b.unchanged && a.offset == b.offset && a.scale == b.scale;
    packed.storage = {(1 - fraction) * a.offset + fraction * b.offset, std::min(a.scale, b.scale), unchanged};
    if (a.offset == b.offset) packed.storage.offset = a.offset;
    const bool floats = from.field.type() == ScalarType::float32 && to.field.type() == ScalarType::float32;
    packed.field = Array(floats ? ScalarType::float32 : ScalarType::float64, nullptr, 0, 1, nullptr);
    FieldReport& report = packed.field_report;
    const FieldReport& other = to.field_report;
    report.lower = std::min(report.lower, other.lower);
    report.upper = std::max(report.upper, other.upper);
    report.no_data = std::max(report.no_data, other.no_data);
    report.infinite = std::max(report.infinite, other.infinite);
    report.flushed = std::max(report.flushed, other.flushed);
    report.offset = packed.storage.offset;
    report.scale = packed.storage.scale;
    report.unchanged = unchanged;
    packed.storage_cache = std::make_shared<core::StorageCache>();
}

/// Directions of the gradients of both steps, of unit length each: how steep they are is not known.
std::uint32_t blended_direction(std::uint32_t a, std::uint32_t b, double fraction) {
    std::array<double, 3> sum{};
    for (const auto& [code, part] : {std::pair(a, 1 - fraction), std::pair(b, fraction)}) {
        const std::array<int, 3> n = core::decode_normal(code);
        const double x = n[0], y = n[1], z = n[2], length = std::sqrt(x * x + y * y + z * z);
        if (length == 0) continue;
        for (std::size_t axis = 0; axis < 3; ++axis) sum[axis] += part * n[axis] / length;
    }
    return core::encode_normal(sum);
}

void blend_gradients(const Packed& from, const Packed& to, double fraction, std::uint64_t first, std::uint64_t last,
                     Packed& packed) {
    for (std::uint64_t i = first; i < last; ++i)
        packed.gradients[i] = blended_direction(from.gradients[i], to.gradients[i], fraction);
}

std::array<double, 3> blended(const std::array<double, 3>& a, const std::array<double, 3>& b, double fraction) {
    std::array<double, 3> out;
    for (std::size_t axis = 0; axis < 3; ++axis)
        out[axis] = a[axis] == b[axis] ? a[axis] : (1 - fraction) * a[axis] + fraction * b[axis];
    return out;
}

/// The points of a boundary; `a` becomes what is between.
void blend_boundary(StoredBoundary& a, const StoredBoundary& b, double fraction) {
    std::visit(
        [&]<class Real>(std::vector<Real>& positions) {
            const Blend<Real> blend(fraction);
            const auto& next = std::get<std::vector<Real>>(b.positions);
            for (std::size_t i = 0; i < positions.size(); ++i) positions[i] = blend.coordinate(positions[i], next[i]);
        },
        a.positions);
    a.origin = blended(a.origin, b.origin, fraction);
}

template <class Real>
void blend_values(const Packed& from, const Packed& to, const Blend<Real>& blend, std::uint64_t first,
                  std::uint64_t last, Packed& packed) {
    const Real* const a = from.as<Real>().values.data();
    const Real* const b = to.as<Real>().values.data();
    Real* const out = packed.as<Real>().values.data();
    for (std::uint64_t i = first; i < last; ++i) out[i] = blend(a[i], b[i]);
}

template <class Real>
void blend_positions(const Packed& from, const Packed& to, double fraction, std::uint64_t first, std::uint64_t last,
                     Packed& packed) {
    const Blend<Real> blend(fraction);
    const Real* const a = from.as<Real>().positions.data();
    const Real* const b = to.as<Real>().positions.data();
    Real* const out = packed.as<Real>().positions.data();
    for (std::uint64_t i = 3 * first; i < 3 * last; ++i) out[i] = blend.coordinate(a[i], b[i]);
}

/// Whether both grids have the positions of the same array.
bool same_points(const Packed& a, const Packed& b) {
    return std::visit(
        [&]<class Real>(const core::Values<Real>& reals) {
            return reals.positions.data() == b.as<Real>().positions.data();
        },
        a.reals);
}

class BlendedResidency final : public core::Residency {
public:
    BlendedResidency(std::shared_ptr<FileResidency> from, std::shared_ptr<FileResidency> to, double fraction);
    ~BlendedResidency() override;

    const Packed& packed() const { return packed_; }

    Result<core::Brought> bring(std::span<const std::uint32_t> clusters, core::Parts parts, Amount amount,
                                const Progress& progress) const override;
    Result<std::optional<Surface>> boundary() const override;
    Result<Array> boundary_values() const override;
    Use use() const override { return from_->use(); }
    Result<std::shared_ptr<const Packed>> whole(const Progress& progress) const override;

private:
    template <class Real>
    Blend<Real> blend() const {
        return Blend<Real>(fraction_, from_->packed().storage.scale, to_->packed().storage.scale);
    }
    template <class Real>
    void make_ranges();
    template <class Real>
    void fill_values(std::size_t chunk);
    void add(std::vector<ChunkedArray> arrays, std::function<void(std::size_t chunk)> fill);
    ChunkRange range_of(std::size_t chunk) const {
        return chunk_range(from_->store()->source().directory, from_->store()->cache().places(), chunk);
    }

    std::shared_ptr<FileResidency> from_, to_;
    double fraction_;
    bool moves_, has_gradients_;
    Packed packed_;
    std::vector<std::unique_ptr<CachedPieces>> made_; ///< values; and positions where points move
};

BlendedResidency::BlendedResidency(std::shared_ptr<FileResidency> from, std::shared_ptr<FileResidency> to,
                                   double fraction)
    : from_(std::move(from)),
      to_(std::move(to)),
      fraction_(fraction),
      moves_(!same_points(from_->packed(), to_->packed())),
      has_gradients_(from_->field().gradients && to_->field().gradients),
      packed_(from_->packed()) {
    set_storage(from_->packed(), to_->packed(), fraction, packed_);
    if (!has_gradients_) packed_.report.gradient_bytes = 0;
    const ArrayMaker maker(ArrayMaker::As::reserved, from_->store()->cache().places());
    FieldEntry field;
    field.gradients = has_gradients_;
    std::vector<ChunkedArray> values = make_value_arrays(field, maker, packed_);
    if (packed_.single()) {
        make_ranges<float>();
        add(std::move(values), [this](std::size_t chunk) { fill_values<float>(chunk); });
    } else {
        make_ranges<double>();
        add(std::move(values), [this](std::size_t chunk) { fill_values<double>(chunk); });
    }
    if (!moves_) return;
    packed_.origin = blended(from_->packed().origin, to_->packed().origin, fraction);
    add(make_position_arrays(maker, packed_), [this](std::size_t chunk) {
        const ChunkRange range = range_of(chunk);
        const std::uint64_t first = range.first_point, last = first + range.points;
        if (packed_.single()) blend_positions<float>(from_->packed(), to_->packed(), fraction_, first, last, packed_);
        else blend_positions<double>(from_->packed(), to_->packed(), fraction_, first, last, packed_);
    });
}

BlendedResidency::~BlendedResidency() {
    for (const auto& pieces : made_) from_->store()->cache().remove(*pieces);
}

void BlendedResidency::add(std::vector<ChunkedArray> arrays, std::function<void(std::size_t chunk)> fill) {
    PieceKind kind;
    kind.arrays = std::move(arrays);
    kind.fill = std::move(fill);
    made_.push_back(std::make_unique<CachedPieces>(std::move(kind), from_->store()->source().directory.chunks.size()));
    from_->store()->cache().add(*made_.back());
}

template <class Real>
void BlendedResidency::make_ranges() {
    const auto& a = from_->packed().as<Real>().ranges;
    const auto& b = to_->packed().as<Real>().ranges;
    core::SharedBuffer<core::Range<Real>> ranges(packed_.clusters());
    core::SharedBuffer<std::uint8_t> has_no_data(packed_.clusters());
    const Blend<Real> both = blend<Real>();
    const auto is_infinite = [](core::Range<Real> range) {
        return range.lower <= -Real(core::stored_infinity) || range.upper >= Real(core::stored_infinity);
    };
    core::parallel_ranges(packed_.clusters(), 4'096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t c = begin; c < end; ++c) {
            ranges[c] = both.range(a[c], b[c]);
            const bool opposite = is_infinite(a[c]) && is_infinite(b[c]); // infinities, which blend to no data
            has_no_data[c] = from_->packed().has_no_data[c] != 0 || to_->packed().has_no_data[c] != 0 || opposite;
        }
    });
    packed_.as<Real>().ranges = std::move(ranges);
    packed_.has_no_data = std::move(has_no_data);
}

/// Values of a chunk, and ranges of its groups that hold them: those of both steps in the range of both.
template <class Real>
void BlendedResidency::fill_values(std::size_t chunk) {
    const ChunkRange range = range_of(chunk);
    const Packed &from = from_->packed(), &to = to_->packed();
    const Blend<Real> both = blend<Real>();
    const std::uint64_t first_point = range.first_point, last_point = first_point + range.points;
    blend_values<Real>(from, to, both, first_point, last_point, packed_);
    if (has_gradients_) blend_gradients(from, to, fraction_, first_point, last_point, packed_);
    for (std::uint64_t c = range.first_cluster; c < range.first_cluster + range.clusters; ++c) {
        const core::ClusterHeader& h = packed_.headers[c];
        const core::Range<Real> cluster = packed_.as<Real>().ranges[c];
        for (std::size_t g = h.first_group; g < h.first_group + h.groups(); ++g) {
            const core::Range<Real> group = both.range(values_of(from.group_ranges[g], from.as<Real>().ranges[c]),
                                                       values_of(to.group_ranges[g], to.as<Real>().ranges[c]));
            const int first = core::quantize(group.lower, cluster), last = core::quantize(group.upper, cluster);
            packed_.group_ranges[g] = {static_cast<std::uint8_t>(std::max(first - 1, 0)),
                                       static_cast<std::uint8_t>(std::min(last + 1, 255))};
        }
    }
}

Result<core::Brought> BlendedResidency::bring(std::span<const std::uint32_t> clusters, core::Parts parts, Amount amount,
                                              const Progress& progress) const {
    if (clusters.empty()) return core::Brought{};
    std::vector<CachedPieces*> read = from_->kinds_of_step(), made;
    for (CachedPieces* const kind : to_->kinds_of_step())
        if (std::ranges::find(read, kind) == read.end()) read.push_back(kind);
    for (const auto& kind : made_) made.push_back(kind.get());
    std::vector<CachedPieces*> more = read;
    more.insert(more.end(), made.begin(), made.end());
    auto brought = from_->bring_cells(clusters, parts, amount, more, progress);
    if (!brought) return brought.error();
    const std::vector<std::size_t> chunks = brought->all();
    if (auto ok = brought->pins->add(read, chunks, progress); !ok) return ok.error();
    if (parts == core::Parts::all)
        for (const auto& step : {from_, to_})
            if (auto ok = step->check_hits(clusters.first(brought->count)); !ok) return ok.error();
    if (auto ok = brought->pins->add(made, chunks, progress); !ok) return ok.error();
    return core::Brought{brought->count, std::move(brought->pins)};
}

Result<std::optional<Surface>> BlendedResidency::boundary() const {
    if (!moves_ || !from_->store()->source().directory.boundary) return from_->boundary();
    auto boundary = read_boundary(from_->store()->source(), from_->field().step);
    if (!boundary) return boundary.error();
    const auto next = read_boundary(from_->store()->source(), to_->field().step);
    if (!next) return next.error();
    blend_boundary(*boundary, *next, fraction_);
    return std::optional(surface_of(*std::move(boundary), packed_.point_type));
}

Result<Array> BlendedResidency::boundary_values() const {
    const PackedSource& source = from_->store()->source();
    return std::visit(
        [&]<class Real>(const core::Values<Real>&) -> Result<Array> {
            auto values = read_boundary_values<Real>(source, from_->field());
            if (!values) return values.error();
            const auto next = read_boundary_values<Real>(source, to_->field());
            if (!next) return next.error();
            const Blend<Real> both = blend<Real>();
            for (std::size_t i = 0; i < values->size(); ++i) (*values)[i] = both((*values)[i], (*next)[i]);
            return user_values(*values, packed_.field.type(), packed_.storage);
        },
        packed_.reals);
}

Result<std::shared_ptr<const Packed>> BlendedResidency::whole(const Progress& progress) const {
    const auto a = from_->whole(progress);
    if (!a) return a;
    const auto b = whole_grid_of_file(from_->store()->source(), to_->field(), a->get(), progress);
    if (!b) return b;
    auto packed = std::make_shared<Packed>(**a);
    set_storage(**a, **b, fraction_, *packed);
    std::visit(
        [&]<class Real>(core::Values<Real>& reals) {
            const std::size_t points = packed->points();
            reals.values = core::SharedBuffer<Real>(points);
            reals.ranges = core::SharedBuffer<core::Range<Real>>(packed->clusters());
            packed->group_ranges = core::SharedBuffer<core::GroupRange>(packed->groups());
            packed->has_no_data = core::SharedBuffer<std::uint8_t>(packed->clusters());
            if (moves_) reals.positions = core::SharedBuffer<Real>(3 * points);
            packed->gradients = core::SharedBuffer<std::uint32_t>(has_gradients_ ? points : 0);
            const Blend<Real> both = blend<Real>();
            core::parallel_ranges(points, 1 << 14, [&](std::size_t begin, std::size_t end) {
                blend_values<Real>(**a, **b, both, begin, end, *packed);
                if (moves_) blend_positions<Real>(**a, **b, fraction_, begin, end, *packed);
                if (has_gradients_) blend_gradients(**a, **b, fraction_, begin, end, *packed);
            });
            core::store_ranges<Real>(*packed, 0, packed->clusters(), progress);
        },
        packed->reals);
    packed->origin = packed_.origin;
    packed->report.gradient_bytes = packed_.report.gradient_bytes;
    if (progress.cancelled()) return Error{ErrorCode::cancelled, "reading was cancelled"};
    return std::shared_ptr<const Packed>(std::move(packed));
}

} // namespace

Result<std::shared_ptr<const Packed>> blended_grid_of_file(const std::shared_ptr<PackedStore>& store,
                                                           const FieldEntry& from, const FieldEntry& to,
                                                           double fraction, const Progress& progress) {
    auto a = FileResidency::make(store, from, progress);
    if (!a) return a.error();
    auto b = FileResidency::make(store, to, progress);
    if (!b) return b.error();
    auto residency = std::make_shared<BlendedResidency>(*std::move(a), *std::move(b), fraction);
    auto packed = std::make_shared<Packed>(residency->packed());
    packed->residency = std::move(residency);
    return std::shared_ptr<const Packed>(std::move(packed));
}

} // namespace isotet::io
