// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Packed files as grids in arrays, for what works on those.
#pragma once

#include "io/reader.hpp"

namespace isotet::io {

GridReader isotet_reader();

} // namespace isotet::io
