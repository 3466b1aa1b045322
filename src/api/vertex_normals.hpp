// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// vertex_normals() on the threads of its caller.
#pragma once

#include <isotet/result.hpp>
#include <isotet/surface.hpp>

namespace isotet {

/// Errors   invalid_data when a triangle has a vertex that is not there
Result<Array> normals_of_vertices(const Surface& surface);

} // namespace isotet
