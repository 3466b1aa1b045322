// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What each method keeps of a tet.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <isotet/draw_tets.hpp>

#include "packed/tet_table.hpp"

namespace isotet::render {

/// Bytes of a tet: 4 x 68, 64 or 16.
std::uint64_t record_bytes(DrawMethod method);

/// Writes the records of tets `first` and following, as many as `out` has room for. Parallel; writes only, in order.
void write_records(DrawMethod method, const core::TetTable& table, std::uint64_t first, std::span<std::byte> out);

} // namespace isotet::render
