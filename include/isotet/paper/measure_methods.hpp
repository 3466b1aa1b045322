// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Methods and search indexes against each other on a grid, or on those of the paper's Figure 4: what `isotet bench` does.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <isotet/paper/grid_bench.hpp>
#include <isotet/isovalues.hpp>
#include <isotet/jobs/device_choice.hpp>
#include <isotet/jobs/field_choice.hpp>
#include <isotet/jobs/grid_source.hpp>

namespace isotet::jobs {

struct BenchJob {
    GridOptions grid;                       ///< `file` is empty with `paper`
    std::vector<std::string> other_outputs; ///< of the caller: no file of the grid may be one
    FieldChoice field;
    std::vector<double> isovalues;          ///< these and `shares` none: three
    std::vector<IsovalueShare> shares = {}; ///< more isovalues, after the others
    bool paper = false;
    std::uint64_t max_tets = 5'000'000;
    std::vector<BenchMethod> methods; ///< none: all that can be
    std::vector<SearchIndex> indexes; ///< none: without and with the interval tree
    std::uint64_t rounds = 5;
    DeviceChoice device;
};

struct BenchNumbers {
    std::string field;
    std::vector<double> isovalues;
    std::optional<DeviceInfo> device;
    unsigned threads = 1;
    std::vector<BenchRow> rows; ///< by grid, then as asked for
};

/// Errors   invalid_argument: what is asked for does not fit together or with the grid; no_device: a device is asked for,
///          and there is none; as of reading and extracting
Result<BenchNumbers> measure_methods(const BenchJob& job, Caller& caller);

} // namespace isotet::jobs
