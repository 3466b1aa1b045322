// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What `isotet bench` prints and writes.
#pragma once

#include <string>

#include <isotet/paper/measure_methods.hpp>

#include "output/json_output.hpp"

namespace isotet::cli {

std::string bench_table(const BenchJob& job, const BenchNumbers& numbers);
Json bench_json(const BenchJob& job, const BenchNumbers& numbers);

} // namespace isotet::cli
