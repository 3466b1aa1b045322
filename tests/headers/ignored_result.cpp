// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Must not compile: an error is thrown away.
#include <isotet/grid.hpp>

void careless(const isotet::Grid& grid) { isotet::survey(grid); }
