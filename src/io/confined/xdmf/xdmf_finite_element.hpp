// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// ItemType FiniteElementFunction: what DOLFIN's write_checkpoint() writes.
#pragma once

#include <cstddef>
#include <string>

#include <pugixml.hpp>

#include <isotet/array.hpp>
#include <isotet/grid.hpp>
#include <isotet/result.hpp>

#include "io/confined/xdmf/xdmf_mesh.hpp"
#include "io/pieces/loaded.hpp"

namespace isotet::io::confined {

bool is_finite_element_function(pugi::xml_node attribute);

/// Cells for degree 0, else points.
Association association_of_function(pugi::xml_node attribute);

struct FunctionValues {
    std::size_t components = 1;
    Array values;     ///< float64; for a description empty
    std::string note; ///< what of the function they are not
};

/// Values of a function of family CG or DG on tetrahedra (degree 0 to 2) or hexahedra (degree 0 and 1): of cells, or at the
/// points of the mesh, and behind these, for degree 2, on its edges, which the mesh then has. Where cells differ at a point it
/// is their mean. Four DataItems: for each cell the numbers of its
/// values, all values, where the numbers of each cell begin; and the numbers of cells, which say nothing: they are in the
/// order of the topology.
///
/// Errors   invalid_data: another family, degree or cell; numbers that are not there
Result<FunctionValues> read_function_values(const XdmfFile& file, pugi::xml_node attribute, XdmfMesh& mesh,
                                            Depth depth);

} // namespace isotet::io::confined
