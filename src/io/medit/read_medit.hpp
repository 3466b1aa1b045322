// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Medit's .mesh and .meshb files with the .sol or .solb beside them: libMeshb's GMF, versions 1 to 4, both byte orders.
#pragma once

#include <optional>
#include <string_view>

#include <isotet/progress.hpp>
#include <isotet/read.hpp>
#include <isotet/result.hpp>

namespace isotet::io {

/// Tells what the two files hold: `medit:ref` on points and cells, and the fields of SolAtVertices, SolAtTetrahedra and so
/// on, on points and on cells in the order of the file `sol`, `sol_1`, `sol_2` and so on.
Result<FileInfo> inspect_medit(std::string_view mesh, std::optional<std::string_view> solution,
                               const Progress& progress);

/// Reads a mesh, and the values at its vertices and in its cells with a volume where there are any. A cell field is NaN
/// where the file gives no value. Values that do not fit the mesh, or are broken, are left out.
///
/// Text or binary is told by the content of each file. Cells come in the order of the file's sections; Edges,
/// Triangles, Quadrilaterals and the quadratic kinds are cells, too. Points are float64, in binary files of version 1
/// float32. A mesh of dimension 2 gets z = 0. Symmetric tensors are in VTK's order: xx yy zz xy yz xz, or xx yy xy.
///
/// Errors   invalid_data: a rule of the format broken, with section, value and rule
Result<ReadResult> parse_medit(std::string_view mesh, std::optional<std::string_view> solution,
                               const ReadOptions& options, const Progress& progress);

} // namespace isotet::io
