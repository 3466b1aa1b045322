// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// OpenFOAM cases: polyhedra, decomposed cases as one grid, values on boundary patches.
#pragma once

#include <optional>
#include <string>

#include <isotet/export.hpp>
#include <isotet/read.hpp>

#include "io/foam/case_files.hpp"
#include "io/pieces/loaded.hpp"
#include "io/reader.hpp"

namespace isotet::io {

/// FILE is the case's folder, a marker (.foam) in it, or its system/controlDict.
GridReader openfoam_reader();

/// True for a folder with constant/polyMesh, of a region too, with processor folders, or with system/controlDict.
ISOTET_API bool is_openfoam_case(const std::string& folder);

/// What a case holds, or its grid too. Each field of cells is announced as one of points, too: with the known values of
/// patches at their points.
ISOTET_API Result<Loaded> load_openfoam_case(const foam::CaseFiles& files, const ReadOptions& options, Depth depth);

} // namespace isotet::io
