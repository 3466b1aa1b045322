// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "core/tet_order.hpp"

#include <algorithm>
#include <limits>

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>
#include <tbb/parallel_sort.h>

#include "core/hilbert.hpp"
#include "core/orientation.hpp"
#include "core/parallel.hpp"

namespace isotet::core {

namespace {

constexpr std::size_t cells_a_chunk = 1 << 14;

struct Partial {
    std::array<double, 3> lower, upper;
    std::uint64_t tets = 0, collapsed = 0, left_out = 0;
    std::int64_t balance = 0; ///< upright minus inverted tetrahedra

    Partial() {
        lower.fill(std::numeric_limits<double>::infinity());
        upper.fill(-std::numeric_limits<double>::infinity());
    }
    void combine(const Partial& other) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            lower[axis] = std::min(lower[axis], other.lower[axis]);
            upper[axis] = std::max(upper[axis], other.upper[axis]);
        }
        tets += other.tets;
        collapsed += other.collapsed;
        left_out += other.left_out;
        balance += other.balance;
    }
};

/// Maps coordinates to steps of the curve's cube, the same scale on all axes.
class CurveSteps {
public:
    explicit CurveSteps(const TetSurvey& survey) : lower_(survey.lower) {
        double extent = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) extent = std::max(extent, survey.upper[axis] - survey.lower[axis]);
        scale_ = extent > 0 ? 0x1.fffffp20 / extent : 0;
        if (!(scale_ < std::numeric_limits<double>::max())) scale_ = 0;
    }
    /// Sums of integer steps do not depend on the order of the corners, so repeated tets get equal keys.
    std::uint64_t key(const PointReader& points, const Tet& tet) const {
        std::array<std::uint32_t, 3> sum{};
        for (const std::uint64_t corner : tet) {
            const Point p = points[corner];
            for (std::size_t axis = 0; axis < 3; ++axis)
                sum[axis] += static_cast<std::uint32_t>((p[axis] - lower_[axis]) * scale_);
        }
        return hilbert_index(sum[0] >> 2, sum[1] >> 2, sum[2] >> 2);
    }

private:
    std::array<double, 3> lower_;
    double scale_;
};

Tet corners_of_tet(const CellReader& cells, TetId id) {
    Tet t = cells.tets(id.cell()).tets[id.piece()];
    std::sort(t.begin(), t.end());
    return t;
}

/// Drops repeated tets, which have equal keys and so stand in one run. Returns the number left.
std::size_t drop_repeated(const CellReader& cells, Buffer<SortedTet>& tets) {
    std::size_t kept = 0;
    std::vector<std::pair<Tet, TetId>> run;
    const std::size_t n = tets.size();
    for (std::size_t begin = 0; begin < n;) {
        std::size_t end = begin + 1;
        while (end < n && tets[end].key == tets[begin].key) ++end;
        if (end - begin == 1) {
            tets[kept++] = tets[begin];
        } else {
            const std::uint64_t key = tets[begin].key;
            run.clear();
            for (std::size_t i = begin; i < end; ++i) run.emplace_back(corners_of_tet(cells, tets[i].tet), tets[i].tet);
            std::sort(run.begin(), run.end(), [](const auto& a, const auto& b) {
                return a.first != b.first ? a.first < b.first : a.second.value < b.second.value;
            });
            run.erase(std::unique(run.begin(), run.end(), [](const auto& a, const auto& b) { return a.first == b.first; }),
                      run.end());
            std::sort(run.begin(), run.end(), [](const auto& a, const auto& b) { return a.second.value < b.second.value; });
            for (const auto& [corners, id] : run) tets[kept++] = {key, id};
        }
        begin = end;
    }
    return kept;
}

} // namespace

TetSurvey survey_tets(const Grid& grid, const CellReader& cells) {
    const PointReader points(grid.points);
    const Partial total = tbb::parallel_reduce(
        tbb::blocked_range<std::size_t>(0, cells.count(), cells_a_chunk), Partial{},
        [&](const tbb::blocked_range<std::size_t>& range, Partial partial) {
            for (std::size_t cell = range.begin(); cell < range.end(); ++cell) {
                const std::uint8_t type = cells.type(cell);
                if (!is_contoured(type)) {
                    ++partial.left_out;
                    continue;
                }
                const CellTets tets = cells.tets(cell);
                partial.tets += static_cast<std::uint64_t>(tets.count);
                partial.collapsed += static_cast<std::uint64_t>(tets.collapsed);
                for (const Tet& tet : tets) {
                    for (const std::uint64_t corner : tet) {
                        const Point p = points[corner];
                        for (std::size_t axis = 0; axis < 3; ++axis) {
                            partial.lower[axis] = std::min(partial.lower[axis], p[axis]);
                            partial.upper[axis] = std::max(partial.upper[axis], p[axis]);
                        }
                    }
                    if (type == static_cast<std::uint8_t>(CellType::tetrahedron)) partial.balance += points.orientation(tet);
                }
            }
            return partial;
        },
        [](Partial a, const Partial& b) {
            a.combine(b);
            return a;
        });
    TetSurvey survey;
    if (total.tets) {
        survey.lower = total.lower;
        survey.upper = total.upper;
    }
    survey.tets = total.tets;
    survey.collapsed = total.collapsed;
    survey.left_out = total.left_out;
    survey.mostly_negative = total.balance < 0;
    return survey;
}

Result<TetOrder> sort_tets(const Grid& grid, const CellReader& cells, const TetSurvey& survey, const Progress& progress) {
    // Where each chunk of cells starts writing.
    const std::size_t chunks = (cells.count() + cells_a_chunk - 1) / cells_a_chunk;
    std::vector<std::uint64_t> first(chunks + 1, 0);
    parallel_each(chunks, 1, [&](std::size_t chunk) {
        std::uint64_t count = 0;
        const std::size_t end = std::min(cells.count(), (chunk + 1) * cells_a_chunk);
        for (std::size_t cell = chunk * cells_a_chunk; cell < end; ++cell)
            count += static_cast<std::uint64_t>(cells.tets(cell).count);
        first[chunk + 1] = count;
    });
    for (std::size_t chunk = 0; chunk < chunks; ++chunk) first[chunk + 1] += first[chunk];

    TetOrder order;
    order.tets = Buffer<SortedTet>(survey.tets);
    const PointReader points(grid.points);
    const CurveSteps steps(survey);
    parallel_each(chunks, 1, [&](std::size_t chunk) {
        if (progress.cancelled()) return;
        SortedTet* out = order.tets.data() + first[chunk];
        const std::size_t end = std::min(cells.count(), (chunk + 1) * cells_a_chunk);
        for (std::size_t cell = chunk * cells_a_chunk; cell < end; ++cell) {
            const CellTets tets = cells.tets(cell);
            for (int piece = 0; piece < tets.count; ++piece)
                *out++ = {steps.key(points, tets.tets[static_cast<std::size_t>(piece)]),
                          TetId::make(cell, static_cast<unsigned>(piece))};
        }
    });
    if (progress.cancelled()) return Error{ErrorCode::cancelled, "packing was cancelled"};
    progress("pack", 0.1);
    tbb::parallel_sort(order.tets.begin(), order.tets.end(), [](const SortedTet& a, const SortedTet& b) {
        return a.key != b.key ? a.key < b.key : a.tet.value < b.tet.value;
    });
    if (progress.cancelled()) return Error{ErrorCode::cancelled, "packing was cancelled"};
    const std::size_t kept = drop_repeated(cells, order.tets);
    order.repeated = order.tets.size() - kept;
    order.tets.shrink(kept);
    progress("pack", 0.3);
    return order;
}

} // namespace isotet::core
