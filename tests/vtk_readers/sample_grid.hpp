// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// A small grid of tetrahedra, a hexahedron, a wedge, a pyramid and a triangle with fields of several types, as VTK has
// it, and what isotet has to make of it.
#pragma once

#include <functional>
#include <string>

#include <vtkSmartPointer.h>
#include <vtkUnstructuredGrid.h>

#include <isotet/read.hpp>

namespace isotet::test {

/// 5 tetrahedra in a cube, and beside it one cell of every other kind. Point fields "height" (float64), "velocity"
/// (float32, 3), "number" (int32); cell fields "region" (int64), "quality: a/b" (float32).
vtkSmartPointer<vtkUnstructuredGrid> sample_grid();

/// Fails the test where the grid that was read is not the sample.
void expect_sample(const Result<ReadResult>& result);

enum class Encoding { ascii, base64, appended_base64, appended_raw, appended_raw_compressed };
void write_vtu(vtkUnstructuredGrid* grid, const std::string& path, Encoding encoding);

/// Reads every prefix of the content, stepping by `step`, from a file with that name's ending, and calls `judge` with
/// what came of it and the length.
void read_prefixes(const std::string& content, const std::string& name, std::size_t step,
                   const std::function<void(const Result<ReadResult>&, std::size_t)>& judge);

} // namespace isotet::test
