// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Time steps of a file, the next one read ahead.
#pragma once

#include <isotet/grid.hpp>

#include "base/threads/read_ahead.hpp"

namespace isotet::view {

using StepReader = core::ReadAhead<Grid>;

/// Reads a time step with all fields.
using ReadStep = StepReader::Read;

} // namespace isotet::view
