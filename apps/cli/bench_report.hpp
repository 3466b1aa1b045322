// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What `isotet bench` prints and writes.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <isotet/grid_bench.hpp>

#include "json_output.hpp"
#include "options.hpp"

namespace isotet::cli {

struct BenchNumbers {
    const BenchCommand* command = nullptr;
    std::string field;
    std::vector<double> isovalues;
    std::optional<DeviceInfo> device;
    unsigned threads = 1;
    std::vector<BenchRow> rows; ///< by grid, then as asked for
};

std::string bench_table(const BenchNumbers& numbers);
Json bench_json(const BenchNumbers& numbers);

} // namespace isotet::cli
