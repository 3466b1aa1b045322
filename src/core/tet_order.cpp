// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "core/tet_order.hpp"

#include <algorithm>
#include <atomic>
#include <limits>
#include <span>
#include <utility>

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>
#include <tbb/parallel_sort.h>

#include "core/hilbert.hpp"
#include "core/orientation.hpp"
#include "core/parallel.hpp"
#include "core/radix_sort.hpp"

namespace isotet::core {

namespace {

constexpr std::size_t cells_a_chunk = 1 << 14;
constexpr std::size_t small_bucket = 64; ///< tets of one lowest point, nearly always fewer

struct Bounds {
    Point lower, upper;

    Bounds() {
        lower.fill(std::numeric_limits<double>::infinity());
        upper.fill(-std::numeric_limits<double>::infinity());
    }
    void add(const Point& p) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            lower[axis] = std::min(lower[axis], p[axis]);
            upper[axis] = std::max(upper[axis], p[axis]);
        }
    }
    void combine(const Bounds& other) {
        add(other.lower);
        add(other.upper);
    }
};

Bounds bounds_of(const PointReader& points, const Buffer<std::uint8_t>& used) {
    return tbb::parallel_reduce(
        tbb::blocked_range<std::size_t>(0, used.size(), 1 << 16), Bounds{},
        [&](const tbb::blocked_range<std::size_t>& range, Bounds bounds) {
            for (std::size_t i = range.begin(); i < range.end(); ++i)
                if (used[i]) bounds.add(points[i]);
            return bounds;
        },
        [](Bounds a, const Bounds& b) {
            a.combine(b);
            return a;
        });
}

/// Maps points to a Hilbert curve through the cube around the grid, 2^21 steps a side, the same scale on all axes.
class Curve {
public:
    explicit Curve(const Bounds& bounds) : lower_(bounds.lower) {
        double extent = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) extent = std::max(extent, bounds.upper[axis] - bounds.lower[axis]);
        scale_ = extent > 0 ? 0x1.fffffp20 / extent : 0;
        if (!(scale_ < std::numeric_limits<double>::max())) scale_ = 0;
    }
    std::uint64_t key(const Point& p) const {
        const auto step = [&](std::size_t axis) { return static_cast<std::uint32_t>((p[axis] - lower_[axis]) * scale_); };
        return hilbert_index(step(0), step(1), step(2));
    }

private:
    Point lower_;
    double scale_;
};

/// The used points along the curve, each with its key; those of equal keys by number.
Buffer<Keyed> sort_points(const PointReader& points, const Buffer<std::uint8_t>& used) {
    constexpr std::size_t points_a_chunk = 1 << 16;
    const std::size_t chunks = (used.size() + points_a_chunk - 1) / points_a_chunk;
    const auto chunk_of = [&](std::size_t chunk) {
        return std::span(used.data(), used.size()).subspan(chunk * points_a_chunk, std::min(points_a_chunk, used.size() - chunk * points_a_chunk));
    };
    std::vector<std::size_t> first(chunks + 1, 0);
    parallel_each(chunks, 1, [&](std::size_t chunk) {
        for (const std::uint8_t flag : chunk_of(chunk)) first[chunk + 1] += flag;
    });
    for (std::size_t chunk = 0; chunk < chunks; ++chunk) first[chunk + 1] += first[chunk];

    const Curve curve(bounds_of(points, used));
    Buffer<Keyed> sorted(first[chunks]), scratch(first[chunks]);
    parallel_each(chunks, 1, [&](std::size_t chunk) {
        Keyed* out = sorted.data() + first[chunk];
        const std::size_t begin = chunk * points_a_chunk;
        for (std::size_t i = begin; i < begin + chunk_of(chunk).size(); ++i)
            if (used[i]) *out++ = {curve.key(points[i]), i};
    });
    radix_sort({sorted.data(), sorted.size()}, {scratch.data(), scratch.size()});
    return sorted;
}

/// Calls f(tet, lowest rank, origin) for all tets, chunks of cells at the same time. Tets are taken some at a time: while
/// one batch is gathered, the ranks of its points and the counters of its lowest ranks are on their way from memory.
/// Returns false when it was cancelled.
template <class F>
bool for_ranked_tets(const PointReader& points, const CellReader& cells, const Buffer<std::uint32_t>& rank_of,
                     const Buffer<std::uint64_t>& counters, const Progress& progress, const F& f) {
    std::atomic<bool> cancelled{false};
    parallel_ranges(cells.count(), cells_a_chunk, [&](std::size_t begin, std::size_t end) {
        if (progress.cancelled()) cancelled = true;
        if (cancelled) return;
        struct Waiting {
            Tet corners;
            RankedTet tet;
            std::uint32_t lowest;
            TetOrigin origin;
        };
        std::array<Waiting, 32> batch;
        std::size_t size = 0;
        const auto flush = [&] {
            for (Waiting& w : std::span(batch.data(), size)) {
                for (std::size_t k = 0; k < 4; ++k) w.tet[k] = rank_of[w.corners[k]];
                w.lowest = std::min(std::min(w.tet[0], w.tet[1]), std::min(w.tet[2], w.tet[3]));
                __builtin_prefetch(&counters[w.lowest], 1);
            }
            for (const Waiting& w : std::span(batch.data(), size)) f(w.tet, w.lowest, w.origin);
            size = 0;
        };
        cells.for_cells(begin, end, [&](std::size_t cell, const CellTets& pieces) {
            const bool cell_negative = !Orienter::is_whole(cells.type(cell)) && Orienter::six_volumes(points, pieces) < 0;
            for (unsigned piece = 0; piece < static_cast<unsigned>(pieces.count); ++piece) {
                const Tet& corners = pieces.tets[piece];
                for (const std::uint64_t corner : corners) __builtin_prefetch(&rank_of[corner]);
                batch[size++] = {corners, {}, 0, TetOrigin::make(cell, piece, cell_negative)};
                if (size == batch.size()) flush();
            }
        });
        flush();
    });
    return !cancelled;
}

std::uint64_t count_up(std::uint64_t& counter) {
    return std::atomic_ref<std::uint64_t>(counter).fetch_add(1, std::memory_order_relaxed);
}

/// Sorts the tets of one lowest rank, which arrive in any order, by origin.
void sort_bucket(std::span<RankedTet> tets, std::span<TetOrigin> origins) {
    for (std::size_t i = 1; i < tets.size(); ++i) {
        const RankedTet tet = tets[i];
        const TetOrigin origin = origins[i];
        std::size_t at = i;
        for (; at > 0 && origins[at - 1].value > origin.value; --at) {
            tets[at] = tets[at - 1];
            origins[at] = origins[at - 1];
        }
        tets[at] = tet;
        origins[at] = origin;
    }
}

/// The same for a point with very many tets.
void sort_large_bucket(std::span<RankedTet> tets, std::span<TetOrigin> origins) {
    std::vector<std::pair<std::uint64_t, RankedTet>> all(tets.size());
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = {origins[i].value, tets[i]};
    tbb::parallel_sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    for (std::size_t i = 0; i < all.size(); ++i) {
        origins[i] = {all[i].first};
        tets[i] = all[i].second;
    }
}

RankedTet ascending(RankedTet tet) {
    std::sort(tet.begin(), tet.end());
    return tet;
}

/// Calls f(position) for each tet of a bucket that has the corners of an earlier one.
template <class F>
void for_repeated(std::span<const RankedTet> tets, std::vector<std::pair<RankedTet, std::size_t>>& scratch, const F& f) {
    const auto sum = [](const RankedTet& t) { return std::uint64_t{t[0]} + t[1] + t[2] + t[3]; };
    if (tets.size() <= small_bucket) {
        std::array<std::uint64_t, small_bucket> sums;
        for (std::size_t i = 0; i < tets.size(); ++i) {
            sums[i] = sum(tets[i]);
            for (std::size_t k = 0; k < i; ++k)
                if (sums[k] == sums[i] && ascending(tets[k]) == ascending(tets[i])) {
                    f(i);
                    break;
                }
        }
        return;
    }
    scratch.clear();
    for (std::size_t i = 0; i < tets.size(); ++i) scratch.emplace_back(ascending(tets[i]), i);
    std::sort(scratch.begin(), scratch.end());
    for (std::size_t i = 1; i < scratch.size(); ++i)
        if (scratch[i].first == scratch[i - 1].first) f(scratch[i].second);
}

/// What turning the tets of some ranks finds out.
struct Turned {
    Orienter::Counts counts;
    std::int64_t balance = 0;              ///< upright minus negative tetrahedra, repeated ones too
    std::vector<std::uint64_t> repeated;   ///< positions
    std::vector<std::uint64_t> flat;       ///< positions of flat tetrahedra: turned as most are, once that is known
};

/// Gives sorted tets their stored form.
class Turner {
public:
    Turner(const Grid& grid, const CellReader& cells, TetOrder& order) : points_(grid.points), cells_(cells), order_(order) {}

    /// The tets [begin, end), which have one lowest rank and are in any order.
    void turn(std::uint64_t begin, std::uint64_t end, Turned& out) {
        const std::span<RankedTet> tets(order_.tets.data() + begin, end - begin);
        const std::span<TetOrigin> origins(order_.origins.data() + begin, end - begin);
        if (tets.size() <= small_bucket) sort_bucket(tets, origins);
        else sort_large_bucket(tets, origins);
        repeated_.assign(tets.size(), 0);
        for_repeated(tets, scratch_, [&](std::size_t i) { repeated_[i] = 1; });
        for (std::size_t i = 0; i < tets.size(); ++i) turn_one(begin + i, repeated_[i] != 0, out);
    }

private:
    struct Corner {
        std::uint64_t point;
        std::uint32_t rank;
        bool operator<(const Corner& other) const { return point < other.point; }
    };

    void turn_one(std::uint64_t position, bool repeated, Turned& out) {
        RankedTet& tet = order_.tets[position];
        std::array<Corner, 4> corners;
        for (std::size_t k = 0; k < 4; ++k) corners[k] = {order_.point_of[tet[k]], tet[k]};
        const int sign = points_.orientation({corners[0].point, corners[1].point, corners[2].point, corners[3].point});
        const bool whole = Orienter::is_whole(cells_.type(order_.origins[position].cell()));
        if (whole) out.balance += sign;
        if (repeated) {
            out.repeated.push_back(position);
            return;
        }
        if (whole && sign == 0) out.flat.push_back(position);
        if (out.counts.add(sign, whole, order_.origins[position].cell_negative())) std::swap(corners[2], corners[3]);
        corners = canonical(corners);
        for (std::size_t k = 0; k < 4; ++k) tet[k] = corners[k].rank;
    }

    PointReader points_;
    const CellReader& cells_;
    TetOrder& order_;
    std::vector<std::uint8_t> repeated_;
    std::vector<std::pair<RankedTet, std::size_t>> scratch_;
};

/// Removes the items at some positions, ascending.
template <class T>
void drop(Buffer<T>& items, const std::vector<std::uint64_t>& dropped) {
    if (dropped.empty() || items.empty()) return;
    T* out = items.data() + dropped[0];
    for (std::size_t k = 0; k < dropped.size(); ++k)
        out = std::copy(items.data() + dropped[k] + 1, items.data() + (k + 1 < dropped.size() ? dropped[k + 1] : items.size()), out);
    items.shrink(items.size() - dropped.size());
}

struct Partial {
    Bounds bounds;
    std::uint64_t tets = 0, collapsed = 0, left_out = 0;
    std::int64_t balance = 0; ///< upright minus inverted tetrahedra

    void combine(const Partial& other) {
        bounds.combine(other.bounds);
        tets += other.tets;
        collapsed += other.collapsed;
        left_out += other.left_out;
        balance += other.balance;
    }
};

} // namespace

TetSurvey survey_tets(const Grid& grid, const CellReader& cells) {
    const PointReader points(grid.points);
    const Partial total = tbb::parallel_reduce(
        tbb::blocked_range<std::size_t>(0, cells.count(), cells_a_chunk), Partial{},
        [&](const tbb::blocked_range<std::size_t>& range, Partial partial) {
            cells.for_cells(range.begin(), range.end(), [&](std::size_t cell, const CellTets& tets) {
                const std::uint8_t type = cells.type(cell);
                partial.left_out += !is_contoured(type);
                partial.tets += static_cast<std::uint64_t>(tets.count);
                partial.collapsed += static_cast<std::uint64_t>(tets.collapsed);
                for (const Tet& tet : tets) {
                    for (const std::uint64_t corner : tet) partial.bounds.add(points[corner]);
                    if (Orienter::is_whole(type)) partial.balance += points.orientation(tet);
                }
            });
            return partial;
        },
        [](Partial a, const Partial& b) {
            a.combine(b);
            return a;
        });
    TetSurvey survey;
    if (total.tets) {
        survey.lower = total.bounds.lower;
        survey.upper = total.bounds.upper;
    }
    survey.tets = total.tets;
    survey.collapsed = total.collapsed;
    survey.left_out = total.left_out;
    survey.mostly_negative = total.balance < 0;
    return survey;
}

TetCounts count_tets(const CellReader& cells) {
    TetCounts counts;
    counts.used = Buffer<std::uint8_t>(cells.points());
    parallel_ranges(cells.points(), 1 << 18, [&](std::size_t begin, std::size_t end) { std::fill_n(counts.used.data() + begin, end - begin, 0); });
    std::atomic<std::uint64_t> all_tets{0}, all_collapsed{0}, all_left_out{0};
    parallel_ranges(cells.count(), cells_a_chunk, [&](std::size_t begin, std::size_t end) {
        std::uint64_t tets = 0, collapsed = 0, left_out = 0;
        cells.for_cells(begin, end, [&](std::size_t cell, const CellTets& pieces) {
            tets += static_cast<std::uint64_t>(pieces.count);
            collapsed += static_cast<std::uint64_t>(pieces.collapsed);
            left_out += !is_contoured(cells.type(cell));
            for (const Tet& tet : pieces)
                for (const std::uint64_t corner : tet)
                    std::atomic_ref<std::uint8_t>(counts.used[corner]).store(1, std::memory_order_relaxed);
        });
        all_tets += tets;
        all_collapsed += collapsed;
        all_left_out += left_out;
    });
    counts.tets = all_tets;
    counts.collapsed = all_collapsed;
    counts.left_out = all_left_out;
    return counts;
}

Result<TetOrder> sort_tets(const Grid& grid, const CellReader& cells, TetCounts counts, bool keep_origins, const Progress& progress) {
    const auto cancelled = [] { return Error{ErrorCode::cancelled, "packing was cancelled"}; };
    const PointReader points(grid.points);
    TetOrder order;
    Buffer<std::uint32_t> rank_of(counts.used.size());
    {
        const Buffer<Keyed> sorted = sort_points(points, counts.used);
        counts.used.release();
        constexpr std::size_t limit = std::numeric_limits<std::uint32_t>::max();
        if (sorted.size() >= limit)
            return Error{ErrorCode::invalid_data, fmt::format("the tets use {} points, but there can be {}", sorted.size(), limit - 1)};
        order.point_of = Buffer<std::uint64_t>(sorted.size());
        parallel_ranges(sorted.size(), 1 << 16, [&](std::size_t begin, std::size_t end) {
            for (std::size_t rank = begin; rank < end; ++rank) {
                order.point_of[rank] = sorted[rank].number;
                rank_of[sorted[rank].number] = static_cast<std::uint32_t>(rank);
            }
        });
    }
    if (progress.cancelled()) return cancelled();
    progress("pack", 0.05);

    // Tets by their lowest rank: counted, then each put where the next one goes.
    const std::size_t ranks = order.point_of.size();
    Buffer<std::uint64_t> next(ranks + 1);
    parallel_ranges(next.size(), 1 << 16, [&](std::size_t begin, std::size_t end) { std::fill_n(next.data() + begin, end - begin, 0); });
    const auto count = [&](const RankedTet&, std::uint32_t lowest, TetOrigin) { count_up(next[lowest]); };
    if (!for_ranked_tets(points, cells, rank_of, next, progress, count)) return cancelled();
    for (std::uint64_t rank = 0, sum = 0; rank <= ranks; ++rank) sum += std::exchange(next[rank], sum);
    order.tets = Buffer<RankedTet>(counts.tets);
    order.origins = Buffer<TetOrigin>(counts.tets);
    const auto put = [&](const RankedTet& tet, std::uint32_t lowest, TetOrigin origin) {
        const std::uint64_t at = count_up(next[lowest]);
        order.tets[at] = tet;
        order.origins[at] = origin;
    };
    if (!for_ranked_tets(points, cells, rank_of, next, progress, put)) return cancelled();
    rank_of.release();
    progress("pack", 0.2);

    constexpr std::size_t ranks_a_chunk = 4096;
    std::vector<Turned> turned((ranks + ranks_a_chunk - 1) / ranks_a_chunk);
    parallel_each(turned.size(), 1, [&](std::size_t chunk) {
        if (progress.cancelled()) return;
        Turner turner(grid, cells, order);
        for (std::size_t rank = chunk * ranks_a_chunk; rank < std::min(ranks, (chunk + 1) * ranks_a_chunk); ++rank)
            turner.turn(rank ? next[rank - 1] : 0, next[rank], turned[chunk]); // next[rank] is now where its tets end
    });
    if (progress.cancelled()) return cancelled();
    std::int64_t balance = 0;
    std::vector<std::uint64_t> repeated;
    for (const Turned& part : turned) {
        order.orientation.combine(part.counts);
        balance += part.balance;
        repeated.insert(repeated.end(), part.repeated.begin(), part.repeated.end());
    }
    if (balance < 0) // in the canonical order, mirroring is an exchange of the last two corners
        for (const Turned& part : turned)
            for (const std::uint64_t position : part.flat) std::swap(order.tets[position][2], order.tets[position][3]);
    order.inverted = order.orientation.inverted(balance < 0);
    order.repeated = repeated.size();
    if (!keep_origins) order.origins.release();
    drop(order.tets, repeated);
    drop(order.origins, repeated);
    progress("pack", 0.3);
    return order;
}

} // namespace isotet::core
