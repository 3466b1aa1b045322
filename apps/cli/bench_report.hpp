// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What `isotet bench` prints and writes.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <isotet/device.hpp>

#include "bench_run.hpp"
#include "json_output.hpp"

namespace isotet::cli {

struct BenchNumbers {
    const BenchCommand* command = nullptr;
    std::string field;
    std::vector<double> isovalues;
    std::optional<DeviceInfo> device;
    unsigned threads = 1;
    std::vector<BenchRow> rows; ///< by grid, then as asked for
};

/// What is fastest for so many surfaces of one grid, up to `upto`.
struct Advice {
    std::size_t row = 0;
    double upto = 0; ///< infinite for the last
};

/// Which row is fastest from one surface on, which from more: preparing, and then so much a surface.
std::vector<Advice> advice_of(const std::vector<BenchRow>& rows);

/// How many times as fast drawing with the interval tree is, the mean over the grids; nothing where it was not measured.
std::optional<double> gain_of_interval_tree(const std::vector<BenchRow>& rows, BenchMethod method);

std::string bench_table(const BenchNumbers& numbers);
Json bench_json(const BenchNumbers& numbers);
std::string bench_csv(const BenchNumbers& numbers);
std::string bench_svg(const BenchNumbers& numbers);

} // namespace isotet::cli
