// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "packed/set_field.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "base/workers.hpp"
#include "base/prefetch.hpp"
#include "numbers/storage.hpp"
#include "packed/group_ranges.hpp"
#include "packed/local_values.hpp"

namespace isotet::core {

namespace {

constexpr std::size_t lanes = 16;
constexpr std::size_t clusters_per_task = 64;

// The second where the first is NaN.
template <class Real>
Real lesser(Real a, Real b) {
    return a < b ? a : b;
}
template <class Real>
Real greater(Real a, Real b) {
    return a > b ? a : b;
}

/// Stored values of the local points of a cluster, and what ranges are made of. Values stand in whole lanes, filled up
/// with copies of the first one.
template <class Real>
class LocalRanges {
public:
    LocalRanges(const Packed& packed, std::size_t cluster, const LocalPoints& points)
        : count_(load_values(packed, cluster, points, values_.data())) {
        std::fill(values_.begin() + count_, values_.begin() + padded(), values_[0]);
        std::array<Real, lanes> lower, upper;
        lower.fill(std::numeric_limits<Real>::max());
        upper.fill(std::numeric_limits<Real>::lowest());
        for (std::size_t i = 0; i < padded(); i += lanes) {
            for (std::size_t k = 0; k < lanes; ++k) lower[k] = lesser(values_[i + k], lower[k]); // never NaN
            for (std::size_t k = 0; k < lanes; ++k) upper[k] = greater(values_[i + k], upper[k]);
        }
        range_ = {*std::min_element(lower.begin(), lower.end()), *std::max_element(upper.begin(), upper.end())};
        unsigned no_data = 0;
        for (std::size_t k = 0; k < count_; ++k) no_data |= unsigned{is_nan(values_[k])};
        no_data_ = no_data != 0;
    }

    Range<Real> range() const { return range_; }
    bool no_data() const { return no_data_; }

    /// quantize() for all values; `lower` is 255 and `upper` 0 where there is no data.
    void steps(PointSteps& lower, PointSteps& upper) const {
        const Range<Real> range = range_;
        const Real factor = quantize_factor(range);
        std::array<std::int32_t, max_cluster_points> whole; // bytes could lie anywhere, for all that a compiler knows
        for (std::size_t k = 0; k < padded(); ++k) {
            const Real step = (lesser(values_[k], range.upper) - range.lower) * factor;
            whole[k] = static_cast<std::int32_t>(lesser(step, Real(255)));
        }
        for (std::size_t k = 0; k < padded(); ++k) lower[k] = static_cast<std::uint8_t>(whole[k]);
        upper = lower;
        if (!no_data_) return;
        for (std::size_t k = 0; k < count_; ++k)
            if (is_nan(values_[k])) {
                lower[k] = 255;
                upper[k] = 0;
            }
    }

private:
    std::size_t padded() const { return (count_ + lanes - 1) / lanes * lanes; }

    std::array<Real, max_cluster_points> values_;
    std::size_t count_;
    Range<Real> range_;
    bool no_data_;
};

template <class Real>
void store_ranges(Packed& packed, std::size_t cluster, const LocalPoints& points) {
    const LocalRanges<Real> local(packed, cluster, points);
    packed.as<Real>().ranges[cluster] = local.range();
    packed.has_no_data[cluster] = local.no_data();
    PointSteps lower, upper;
    local.steps(lower, upper);
    const ClusterHeader& h = packed.headers[cluster];
    const StoredTet* words = packed.cells.data() + h.first_word;
    GroupRange* out = packed.group_ranges.data() + h.first_group;
    for (const CellKind kind : cell_kinds) {
        const std::size_t count = words_of(kind) * h.count(kind);
        find_group_ranges({words, count}, lower, upper, out);
        words += count;
        out += h.groups(kind);
    }
}

} // namespace

template <class Real>
void store_ranges(Packed& packed, std::size_t first, std::size_t last, const Progress& progress) {
    const Real* const values = packed.as<Real>().values.data();
    worker_ranges(last - first, clusters_per_task, [&](std::size_t from, std::size_t to) {
        if (progress.cancelled()) return;
        const std::size_t begin = first + from, end = first + to;
        std::array<LocalPoints, 2> points; // of the cluster at hand and the next, in turn
        points[begin % 2].find(packed, begin);
        for (std::size_t c = begin; c < end; ++c) {
            if (c + 1 < end) { // ghost values lie scattered: waiting for them would be half of the work
                LocalPoints& next = points[(c + 1) % 2];
                next.find(packed, c + 1);
                for (std::size_t k = 0; k < next.ghost(); ++k) prefetch(values + next[k]);
            }
            store_ranges<Real>(packed, c, points[c % 2]);
        }
    });
}

template void store_ranges<float>(Packed&, std::size_t, std::size_t, const Progress&);
template void store_ranges<double>(Packed&, std::size_t, std::size_t, const Progress&);

} // namespace isotet::core
