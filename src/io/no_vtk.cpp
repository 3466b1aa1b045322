// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Without VTK no program is a reader process.
#include <isotet/read.hpp>

std::optional<int> isotet::run_as_reader(int, char**) { return std::nullopt; }
