// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <isotet/array.hpp>
#include <isotet/export.hpp>

namespace isotet::io {

/// Times that a file holds as numbers, one component. float32 is taken as it was written: 0.1, not 0.10000000149011612.
ISOTET_API std::vector<double> time_values(const Array& times);

} // namespace isotet::io
