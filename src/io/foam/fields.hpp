// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Fields of a case on its cells, and at its points.
#pragma once

#include <set>
#include <string>
#include <vector>

#include <isotet/grid.hpp>
#include <isotet/result.hpp>

#include "io/foam/case_files.hpp"
#include "io/foam/mesh.hpp"

namespace isotet::io::foam {

struct FieldRequest {
    std::string folder; ///< of the time, and the region, in each part: "0.5/" or "0.5/solid/"
    std::string name;
    bool cells = true, points = true; ///< what is wanted of a cell field
    bool allow_outside = false;
};

/// What was read; an array is empty where it was not asked for.
struct CaseField {
    Array cells, points;
    std::vector<std::string> lacking; ///< parts that do not have it, where there is no data
    std::set<std::string> unread; ///< files of an OpenFOAM installation that its files include
    std::set<std::string> misfits; ///< values of patches that do not fit and are not used: what is wrong with them
};

/// Reads a field of all parts. A point of a patch with known values has the mean of these over the faces around it,
/// another one the mean of the cells around it. NaN is left out of means.
Result<CaseField> read_case_field(const CaseFiles& files, const WholeMesh& whole, const Cells& cells,
                                  const FieldRequest& request);

} // namespace isotet::io::foam
