// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The boundary of a packed grid by its packed points.
#pragma once

#include <cstdint>
#include <vector>

#include <isotet/array.hpp>
#include <isotet/export.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>

#include "packed/packed.hpp"

namespace isotet::core {

struct PackedBoundary {
    std::vector<std::uint64_t> points; ///< packed ones, ascending
    Array triangles;                   ///< uint32, three places among the points each
};

/// Errors   as boundary_of()
ISOTET_API Result<PackedBoundary> find_boundary(const Packed& packed, const Progress& progress);

} // namespace isotet::core
