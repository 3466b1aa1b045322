// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Meshes as they stand in a file: few bytes, and unpacked by what every browser has (web/link/unpack.js).
#pragma once

#include <string>
#include <string_view>

#include <isotet/result.hpp>

#include "view/json.hpp"
#include "view/mesh.hpp"

namespace isotet::view {

/// Columns, one after another: x, y and z of the vertices (16 bits), both places of the normals (8), colours (16, where
/// there are some), corners (16 bits, 32 with more than 65,535 vertices; none of a flat mesh). Vertices come in the
/// order in which triangles use them first.
///
/// A column holds the lowest bytes of all its numbers, then the next bytes. Numbers of vertices are differences to the
/// vertex before, 0 before the first, wrapped around, with 0, -1, 1, -2 and so on as 0, 1, 2, 3. Of corners it is how
/// many vertices were used since: 0 is the next one that no triangle has used, 1 the last that was used first.
///
/// Errors   none; std::bad_alloc is thrown
std::string columns_of(const Mesh& mesh);

/// What a page must know to take columns_of() apart, and the box of the vertices.
Json told_of(const Mesh& mesh);

/// As zlib stores it (RFC 1950), which browsers inflate. Errors   out_of_memory
Result<std::string> deflated(std::string_view bytes);

/// RFC 4648, padded.
std::string base64_of(std::string_view bytes);

} // namespace isotet::view
