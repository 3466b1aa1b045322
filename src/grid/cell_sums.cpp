// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "grid/cell_sums.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <tbb/enumerable_thread_specific.h>

#include "grid/cell/native_cells.hpp"
#include "grid/cell/splitter.hpp"
#include "grid/cell/with_kind.hpp"
#include "grid/orientation.hpp"

namespace isotet::core {

namespace {

/// Six times the volumes of the tets of a cell, rounded as six_volumes() does.
struct TetVolumes {
    const std::array<Point, 8>& places;
    std::array<std::array<std::uint8_t, 4>, 6> tets;
    std::array<double, 6> volumes;
    std::size_t count = 0;

    void expect(int) {}
    void add(std::uint8_t a, std::uint8_t b, std::uint8_t c, std::uint8_t d) {
        tets[count] = {a, b, c, d};
        volumes[count++] = six_volumes(places[a], places[b], places[c], places[d]);
    }
    int sign(std::size_t i) const {
        const auto& [a, b, c, d] = tets[i];
        return orientation_sign(places[a], places[b], places[c], places[d]);
    }
};

/// Volumes beyond this have the sign of the exact one: Shewchuk's bound (numbers/exact.hpp), of which the permanent is at
/// most 6 times the cube of the largest difference of coordinates, and a little more.
double certain_volume(const std::array<Point, 8>& places, std::size_t corners) {
    double extent = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        double lower = places[0][axis], upper = lower;
        for (std::size_t k = 1; k < corners; ++k) {
            lower = std::min(lower, places[k][axis]);
            upper = std::max(upper, places[k][axis]);
        }
        extent = std::max(extent, upper - lower);
    }
    return std::max(0x1p-47 * extent * extent * extent, 0x1p-900);
}

} // namespace

/// Adds cells, and in the end what it counted.
template <class Number>
class CellSums::Adder {
public:
    explicit Adder(CellSums& to) : to_(to), points_(to.points_), sums_(to.sums_) {}

    void finish() {
        sums_.flush();
        to_.tets_.tets += tets_.tets;
        to_.tets_.mirrored += tets_.mirrored;
        to_.tets_.orientation.combine(tets_.orientation);
    }

    void add_tets(const CellReader& cells, std::size_t begin, std::size_t end) {
        cells.for_cells(begin, end, [&](std::size_t, const CellTets& tets) {
            for (const Tet& tet : tets) add_tet(tet);
        });
    }

    void add_cell(const CellReader& cells, std::size_t cell) {
        const std::uint8_t type = cells.type(cell);
        if (!is_contoured(type)) return;
        if (Orienter::is_whole(type)) return add_tets(cells, cell, cell + 1);
        const WholeCell whole = cells.whole(cell);
        if (is_ordered(type) || has_repeated_corner(whole)) return add_parts(type, split_cell(whole));
        sums_.add(whole, is_mirrored(whole));
    }

private:
    void add_tet(const Tet& tet) {
        ++tets_.tets;
        bool mirrored = false;
        if (!to_.turned_alike_) {
            const int sign = points_.orientation(tet);
            mirrored = sign < 0;
            tets_.mirrored += mirrored;
            tets_.orientation.add(sign, true, false);
            if (sign == 0) // it is turned as most are, which is not known yet
                for (const std::uint64_t corner : tet) to_.sums_.doubt(corner);
        }
        sums_.add(AscendingTet<Number>::make(tet, mirrored));
    }

    /// Of a cell with repeated corners, or of an ordered type: a tet of it may be one of a whole cell.
    void add_parts(std::uint8_t type, const CellTets& tets) {
        const bool ordered = is_ordered(type);
        const bool mirrored = !to_.turned_alike_ && !ordered && Orienter::six_volumes(points_, tets) < 0;
        for (const Tet& tet : tets) {
            ++tets_.tets;
            if (!to_.turned_alike_) {
                const int sign = points_.orientation(tet);
                tets_.orientation.add(sign, false, mirrored);
                tets_.mirrored += !ordered && sign < 0;
            }
            const auto made = AscendingTet<Number>::make(tet, mirrored);
            sums_.add(ordered ? made.of_ordered_cell() : made);
            for (const std::uint64_t corner : tet) to_.sums_.doubt(corner);
        }
    }

    /// Whether the volumes of a cell's tets add up to a negative one; counts its tets.
    bool is_mirrored(const WholeCell& cell) {
        if (to_.turned_alike_) return false;
        std::array<Point, 8> places;
        TetVolumes found{places, {}, {}};
        double certain = 0;
        with_kind(cell.kind, [&](auto kind) {
            for (std::size_t k = 0; k < corner_count(kind); ++k) places[k] = points_[cell.corners[k]];
            certain = certain_volume(places, corner_count(kind));
            Splitter(cell.corners.data(), found).split(kind);
        });
        tets_.tets += found.count;
        double sum = 0, least = found.volumes[0], greatest = least;
        for (std::size_t i = 0; i < found.count; ++i) {
            sum += found.volumes[i];
            least = std::min(least, found.volumes[i]);
            greatest = std::max(greatest, found.volumes[i]);
        }
        if (least > certain) return false;
        if (greatest < -certain) {
            tets_.mirrored += found.count;
            return true;
        }
        for (std::size_t i = 0; i < found.count; ++i) {
            const int sign = found.sign(i);
            tets_.orientation.add(sign, false, sum < 0);
            tets_.mirrored += sign < 0;
        }
        return sum < 0;
    }

    CellSums& to_;
    PointReader points_;
    FaceSums::Adder sums_;
    TetSurvey tets_; ///< counts alone
};

struct CellSums::Adders {
    explicit Adders(CellSums& to)
        : narrow([&to] { return Adder<std::uint32_t>(to); }), wide([&to] { return Adder<std::uint64_t>(to); }) {}

    tbb::enumerable_thread_specific<Adder<std::uint32_t>> narrow;
    tbb::enumerable_thread_specific<Adder<std::uint64_t>> wide;
};

CellSums::CellSums(const Array& points, bool turned_alike)
    : points_(points),
      turned_alike_(turned_alike),
      wide_(points.tuples() > AscendingTet<std::uint32_t>::max_points),
      sums_(points.tuples()),
      adders_(std::make_unique<Adders>(*this)) {}

CellSums::~CellSums() = default;

void CellSums::add(const CellReader& cells, std::size_t begin, std::size_t end) {
    const auto add_with = [&](auto& adder) {
        if (cells.only_tets()) adder.add_tets(cells, begin, end);
        else
            for (std::size_t cell = begin; cell < end; ++cell) adder.add_cell(cells, cell);
    };
    if (wide_) add_with(adders_->wide.local());
    else add_with(adders_->narrow.local());
}

void CellSums::finish() {
    for (auto& adder : adders_->narrow) adder.finish();
    for (auto& adder : adders_->wide) adder.finish();
    adders_.reset();
}

Buffer<std::uint8_t> CellSums::take_doubted() {
    count_ = sums_.look();
    return sums_.take_doubted();
}

} // namespace isotet::core
