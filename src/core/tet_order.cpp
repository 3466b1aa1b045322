// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "core/tet_order.hpp"

#include <algorithm>
#include <atomic>
#include <limits>

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include "core/hilbert.hpp"
#include "core/orientation.hpp"
#include "core/parallel.hpp"
#include "core/radix_sort.hpp"

namespace isotet::core {

namespace {

constexpr std::size_t cells_a_chunk = TetCounts::cells_a_chunk;

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

/// A point as steps along the axes, 2^19 a side of the cube around the grid, in three fields of 21 bits. The sum of four
/// points fits: it is the centroid of a tet in four times as many steps, and does not depend on the order of the corners,
/// so that repeated tets have equal keys.
class CurveSteps {
public:
    explicit CurveSteps(const Bounds& bounds) : lower_(bounds.lower) {
        double extent = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) extent = std::max(extent, bounds.upper[axis] - bounds.lower[axis]);
        scale_ = extent > 0 ? 0x1.fffffp18 / extent : 0;
        if (!(scale_ < std::numeric_limits<double>::max())) scale_ = 0;
    }
    std::uint64_t of(const Point& p) const {
        const auto steps = [&](std::size_t axis) { return static_cast<std::uint64_t>(static_cast<std::int64_t>((p[axis] - lower_[axis]) * scale_)); };
        return steps(0) | steps(1) << 21 | steps(2) << 42;
    }
    static std::uint64_t key(std::uint64_t sum) {
        constexpr std::uint64_t field = (1 << 21) - 1;
        return hilbert_index(static_cast<std::uint32_t>(sum & field), static_cast<std::uint32_t>(sum >> 21 & field),
                             static_cast<std::uint32_t>(sum >> 42));
    }

private:
    Point lower_;
    double scale_;
};

/// A point with its steps beside it: in a grid without order, fetching it costs one line of memory, not two.
struct CurvePoint {
    std::uint64_t steps;
    Point place;
};

Buffer<CurvePoint> curve_points(const PointReader& points, const Buffer<std::uint8_t>& used) {
    const CurveSteps steps(bounds_of(points, used));
    Buffer<CurvePoint> out(used.size());
    parallel_ranges(used.size(), 1 << 16, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            if (used[i]) out[i] = {steps.of(points[i]), points[i]};
    });
    return out;
}

/// Turns tets into SortedTets some at a time: while one batch is gathered, its points are on their way from memory.
class TetWriter {
public:
    TetWriter(const Buffer<CurvePoint>& points, SortedTet* out) : points_(points), out_(out) {}

    void add(TetId id, const Tet& corners, bool cell_negative) {
        for (const std::uint64_t corner : corners) __builtin_prefetch(&points_[corner]);
        batch_[size_++] = {id, corners, cell_negative};
        if (size_ == batch_.size()) flush();
    }
    void flush() {
        for (std::size_t i = 0; i < size_; ++i) {
            const Tet& t = batch_[i].corners;
            const CurvePoint &a = points_[t[0]], &b = points_[t[1]], &c = points_[t[2]], &d = points_[t[3]];
            const int sign = orientation_sign(a.place, b.place, c.place, d.place);
            *out_++ = SortedTet::make(CurveSteps::key(a.steps + b.steps + c.steps + d.steps), batch_[i].id,
                                      {sign < 0, sign == 0, batch_[i].cell_negative});
        }
        size_ = 0;
    }

private:
    struct Waiting {
        TetId id;
        Tet corners;
        bool cell_negative;
    };

    const Buffer<CurvePoint>& points_;
    SortedTet* out_;
    std::array<Waiting, 32> batch_;
    std::size_t size_ = 0;
};

/// Writes every tet with its key and its signs. Returns whether most whole tetrahedra are negative.
bool write_tets(const Grid& grid, const CellReader& cells, const TetCounts& counts, Buffer<SortedTet>& tets, const Progress& progress) {
    const PointReader coordinates(grid.points);
    const Buffer<CurvePoint> points = curve_points(coordinates, counts.used);
    std::atomic<std::int64_t> balance{0};
    parallel_each(counts.first.size() - 1, 1, [&](std::size_t chunk) {
        if (progress.cancelled()) return;
        SortedTet* const out = tets.data() + counts.first[chunk];
        TetWriter writer(points, out);
        const std::size_t begin = chunk * cells_a_chunk, end = std::min(cells.count(), begin + cells_a_chunk);
        cells.for_cells(begin, end, [&](std::size_t cell, const CellTets& pieces) {
            const bool cell_negative = !Orienter::is_whole(cells.type(cell)) && Orienter::six_volumes(coordinates, pieces) < 0;
            for (int piece = 0; piece < pieces.count; ++piece)
                writer.add(TetId::make(cell, static_cast<unsigned>(piece)), pieces.tets[static_cast<std::size_t>(piece)], cell_negative);
        });
        writer.flush();
        std::int64_t sum = 0;
        for (const SortedTet* tet = out; tet != tets.data() + counts.first[chunk + 1]; ++tet)
            if (Orienter::is_whole(cells.type(tet->tet().cell()))) sum += tet->signs().flat ? 0 : tet->signs().negative ? -1 : 1;
        balance.fetch_add(sum, std::memory_order_relaxed);
    });
    return balance < 0;
}

Tet sorted_corners(const CellReader& cells, TetId id) {
    Tet t = cells.tets(id.cell()).tets[id.piece()];
    std::sort(t.begin(), t.end());
    return t;
}

/// Finds repeated tets, which have equal keys and so stand in one run: positions of all but the first of each, ascending.
std::vector<std::size_t> find_repeated(const CellReader& cells, const Buffer<SortedTet>& tets) {
    const std::size_t n = tets.size();
    constexpr std::size_t chunk_size = 1 << 16;
    std::vector<std::vector<std::size_t>> found((n + chunk_size - 1) / chunk_size);
    parallel_each(found.size(), 1, [&](std::size_t chunk) {
        std::vector<std::pair<Tet, std::size_t>> run;
        std::size_t begin = chunk * chunk_size;
        const std::size_t stop = std::min(n, begin + chunk_size);
        while (begin > 0 && begin < stop && tets[begin].key == tets[begin - 1].key) ++begin; // that run is not ours
        while (begin < stop) {
            std::size_t end = begin + 1;
            while (end < n && tets[end].key == tets[begin].key) ++end;
            if (end - begin > 1) {
                run.clear();
                for (std::size_t i = begin; i < end; ++i) run.emplace_back(sorted_corners(cells, tets[i].tet()), i);
                std::sort(run.begin(), run.end());
                for (std::size_t i = 1; i < run.size(); ++i)
                    if (run[i].first == run[i - 1].first) found[chunk].push_back(run[i].second);
            }
            begin = end;
        }
    });
    std::vector<std::size_t> all;
    for (const auto& part : found) all.insert(all.end(), part.begin(), part.end());
    std::sort(all.begin(), all.end());
    return all;
}

void drop(Buffer<SortedTet>& tets, const std::vector<std::size_t>& dropped) {
    if (dropped.empty()) return;
    SortedTet* out = tets.data() + dropped[0];
    for (std::size_t k = 0; k < dropped.size(); ++k)
        out = std::copy(tets.data() + dropped[k] + 1, tets.data() + (k + 1 < dropped.size() ? dropped[k + 1] : tets.size()), out);
    tets.shrink(tets.size() - dropped.size());
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
    const std::size_t chunks = (cells.count() + cells_a_chunk - 1) / cells_a_chunk;
    TetCounts counts;
    counts.first.assign(chunks + 1, 0);
    counts.used = Buffer<std::uint8_t>(cells.points());
    parallel_ranges(cells.points(), 1 << 18, [&](std::size_t begin, std::size_t end) { std::fill_n(counts.used.data() + begin, end - begin, 0); });
    std::vector<std::array<std::uint64_t, 2>> without(chunks); // collapsed tets, cells left out
    parallel_each(chunks, 1, [&](std::size_t chunk) {
        std::uint64_t tets = 0, collapsed = 0, left_out = 0;
        const std::size_t begin = chunk * cells_a_chunk, end = std::min(cells.count(), begin + cells_a_chunk);
        cells.for_cells(begin, end, [&](std::size_t cell, const CellTets& pieces) {
            tets += static_cast<std::uint64_t>(pieces.count);
            collapsed += static_cast<std::uint64_t>(pieces.collapsed);
            left_out += !is_contoured(cells.type(cell));
            for (const Tet& tet : pieces)
                for (const std::uint64_t corner : tet)
                    std::atomic_ref<std::uint8_t>(counts.used[corner]).store(1, std::memory_order_relaxed);
        });
        counts.first[chunk + 1] = tets;
        without[chunk] = {collapsed, left_out};
    });
    for (std::size_t chunk = 0; chunk < chunks; ++chunk) {
        counts.first[chunk + 1] += counts.first[chunk];
        counts.collapsed += without[chunk][0];
        counts.left_out += without[chunk][1];
    }
    return counts;
}

Result<TetOrder> sort_tets(const Grid& grid, const CellReader& cells, TetCounts counts, const Progress& progress) {
    const auto cancelled = [] { return Error{ErrorCode::cancelled, "packing was cancelled"}; };
    TetOrder order;
    order.tets = Buffer<SortedTet>(counts.tets());
    order.mostly_negative = write_tets(grid, cells, counts, order.tets, progress);
    counts.used.release();
    if (progress.cancelled()) return cancelled();
    progress("pack", 0.15);
    {
        Buffer<SortedTet> scratch(order.tets.size());
        radix_sort({order.tets.data(), order.tets.size()}, {scratch.data(), scratch.size()});
    }
    if (progress.cancelled()) return cancelled();
    const std::vector<std::size_t> repeated = find_repeated(cells, order.tets);
    drop(order.tets, repeated);
    order.repeated = repeated.size();
    progress("pack", 0.3);
    return order;
}

} // namespace isotet::core
