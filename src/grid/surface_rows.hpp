// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Some vertices and triangles of a surface as a surface.
#pragma once

#include <cstdint>
#include <vector>

#include <isotet/surface.hpp>

namespace isotet::core {

/// The same surface with some of its triangles, and the vertices that these use.
///
/// `triangles`   numbers, ascending
Surface with_triangles(const Surface& surface, const std::vector<std::uint64_t>& triangles);

/// The tuples of an array with some numbers, in their order; itself where it is empty.
ISOTET_API Array rows_of(const Array& array, const std::vector<std::uint64_t>& rows);

} // namespace isotet::core
