// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/paper/grid_bench.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace isotet {

std::vector<BenchAdvice> advice_of(const std::vector<BenchRow>& rows) {
    std::vector<BenchAdvice> advice;
    // By the best rounds: what slows a round down is other programs, and rounds of different rows do not meet the same
    // ones.
    const auto cost = [&](std::size_t row, double surfaces) {
        return rows[row].costs.prepare_seconds + surfaces * rows[row].best.total();
    };
    for (double surfaces = 1;;) {
        std::optional<std::size_t> fastest;
        for (std::size_t row = 0; row < rows.size(); ++row)
            if (rows[row].missing.empty() && (!fastest || cost(row, surfaces) < cost(*fastest, surfaces)))
                fastest = row;
        if (!fastest) return advice;
        // The next row that overtakes it, which must be one with less a surface.
        double upto = std::numeric_limits<double>::infinity();
        for (std::size_t row = 0; row < rows.size(); ++row) {
            const double saved = rows[*fastest].best.total() - rows[row].best.total();
            if (!rows[row].missing.empty() || saved <= 0) continue;
            const double even = (rows[row].costs.prepare_seconds - rows[*fastest].costs.prepare_seconds) / saved;
            upto = std::min(upto, std::max(surfaces, std::floor(even)));
        }
        advice.push_back({*fastest, upto});
        if (upto > 1e15) {
            advice.back().upto = std::numeric_limits<double>::infinity();
            return advice;
        }
        surfaces = upto + 1;
    }
}

std::optional<double> gain_of_interval_tree(const std::vector<BenchRow>& rows, BenchMethod method) {
    double sum = 0;
    int grids = 0;
    for (const BenchRow& with : rows) {
        if (with.pair.method != method || with.pair.index != SearchIndex::interval_tree || !with.missing.empty())
            continue;
        const auto without = std::ranges::find_if(rows, [&](const BenchRow& row) {
            return row.grid == with.grid && row.pair.method == method && row.pair.index == SearchIndex::none &&
                   row.missing.empty();
        });
        if (without == rows.end()) continue;
        sum += without->best.total() / with.best.total();
        ++grids;
    }
    return grids > 0 ? std::optional(sum / grids) : std::nullopt;
}

} // namespace isotet
