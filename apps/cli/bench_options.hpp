// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The options of `isotet bench`.
#pragma once

#include "options.hpp"

namespace isotet::cli {

class Command;

Command add_bench_command(const Command& program, BenchCommand& bench);

} // namespace isotet::cli
