// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Some vertices and triangles of a surface as a surface.
#pragma once

#include <cstdint>
#include <vector>

#include <isotet/surface.hpp>

namespace isotet::checking {

/// `vertices`, `triangles`   numbers, ascending; every vertex of these triangles is among the vertices
Surface with_rows(const Surface& surface, const std::vector<std::uint64_t>& vertices,
                  const std::vector<std::uint64_t>& triangles);

/// The tuples of an array with some numbers, in their order; itself where it is empty.
Array rows_of(const Array& array, const std::vector<std::uint64_t>& rows);

} // namespace isotet::checking
