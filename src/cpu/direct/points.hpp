// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What the pass over the cells needs to know of points: a byte each.
//
// How values and coordinates are stored depends on the points that tets use, but which those are is only known after
// the pass. So it is assumed that all points are used. Those that decide (the ends of a range, say) are watched; when
// some of them have not been seen in the end, survey_points() is asked again without them: the same answer proves the
// assumption.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

#include "base/buffer.hpp"
#include "numbers/exact.hpp"
#include "numbers/storage.hpp"
#include "ops/direct.hpp"

namespace isotet::cpu::direct {

/// Flags of a point at one isovalue. Of the sum over the corners of a cell the low four bits tell how many are above; from
/// 16 on some corner needs attention.
namespace side {
constexpr std::uint8_t above = 0x01;
constexpr std::uint8_t watched = 0x10; ///< it matters whether a tet uses the point, and none was seen yet
constexpr std::uint8_t tied = 0x20;    ///< Ties::merge only
constexpr std::uint8_t no_data = 0x40;
constexpr std::uint8_t unsound = 0x80; ///< coordinates that are not finite or 2^91 or more: no cell may use the point
} // namespace side

/// The flags of all points. The pass over the cells takes `watched` away, from many threads: hence the atomics, which
/// cost nothing more than plain bytes. Numbers that are no points up to the next power of two have flags, too,
/// `unsound`: so a number that was masked can be looked up before it is known to be a point.
class Sides {
public:
    Sides() = default;
    explicit Sides(std::size_t points) : points_(points), flags_(std::bit_ceil(points)) {
        std::fill(flags_.begin() + points, flags_.end(), side::unsound);
    }

    /// All ones; no larger number has flags.
    std::uint64_t mask() const { return flags_.size() - 1; }
    std::uint8_t operator[](std::size_t point) const { return at(point).load(std::memory_order_relaxed); }
    void saw(std::size_t point) {
        const std::uint8_t now = (*this)[point];
        if (now & side::watched) at(point).store(now & ~side::watched, std::memory_order_relaxed);
    }
    std::size_t points() const { return points_; }
    std::size_t bytes() const { return flags_.bytes(); }

    /// For everything that happens before or after the pass.
    core::Buffer<std::uint8_t>& flags() { return flags_; }
    bool is_unseen(std::size_t point) const { return flags_[point] & side::watched; }

private:
    std::atomic_ref<std::uint8_t> at(std::size_t point) const { return std::atomic_ref(flags_.data()[point]); }

    std::size_t points_ = 0;
    mutable core::Buffer<std::uint8_t> flags_;
};

/// False for a point that no cell may use.
inline bool is_sound(const core::Point& p) {
    return std::abs(p[0]) < 0x1p91 && std::abs(p[1]) < 0x1p91 && std::abs(p[2]) < 0x1p91; // false for NaN
}

/// How a field is stored, and what its values are like.
struct StoredField {
    core::ValueStatistics statistics;
    core::Storage storage;
    double smallest = 0; ///< magnitude of (value - offset) * scale other than 0

    /// Some values may be stored as 0 for being small.
    bool may_flush() const { return smallest < 2 * core::tiny; }
};

/// What used points decide on.
struct PointSurvey {
    StoredField field;
    std::uint64_t flushed = 0; ///< values of the field
    std::vector<StoredField> carried;
    bool rounds_coordinates = false; ///< float64 ones to float32
    core::Point lower{}, upper{};    ///< bounds, where coordinates are rounded
    std::array<double, 3> origin{};
    bool framed = false;      ///< storage and origin are those of a frame
    bool has_unsound = false; ///< points that no cell may use, used or not

    /// True when both store everything alike and find the same range.
    bool decides_as(const PointSurvey& other) const;
    FieldReport report(const std::string& name) const;
};

/// Looks at all points, or those that `seen` does not call unseen. Real is the precision that is stored.
template <class Real>
PointSurvey survey_points(const ops::DirectInput& input, const Sides* seen);

/// What to watch besides tied points.
enum class Watch : std::uint8_t {
    nothing,
    deciding, ///< points that decide on the survey
};

struct SidesFound {
    bool tied = false; ///< some point, used or not
    bool near = false; ///< some point holds the value that the field's type has nearest to the isovalue
    std::vector<std::uint8_t> stretches = {}; ///< of side_grain points each: whether any is tied or near
};
constexpr std::size_t side_grain = 1 << 14;

/// The flags of all points.
/// `isovalue`  as the user gave it, and as stored
template <class Real>
SidesFound find_sides(const ops::DirectInput& input, const PointSurvey& survey, double isovalue,
                      const core::StoredIsovalue<Real>& stored, Ties ties, Watch watch, Sides& sides);

/// Counts tied points that were seen, and what else ExtractReport says of ties.
template <class Real>
void report_ties(const ops::DirectInput& input, const PointSurvey& survey, double isovalue,
                 const core::StoredIsovalue<Real>& stored, const SidesFound& found, const Sides& sides,
                 ops::DirectSurface& surface);

} // namespace isotet::cpu::direct
