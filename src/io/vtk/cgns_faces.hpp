// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Polyhedra in CGNS: faces (NGON_n), and the faces of cells (NFACE_n).
#pragma once

#include <string>
#include <vector>

#include <isotet/grid.hpp>
#include <isotet/result.hpp>

namespace isotet::io::vtk {

/// A zone with faces.
struct CgnsFaceZone {
    std::string name; ///< "Base/Zone"
    Cells cells;      ///< where faces tell their cells (ParentElements) and cells not their faces, else none
};

/// Looks at all zones with faces: VTK's reader goes by what they say as it is, and makes polygons where no cell tells its faces.
///
/// Errors   invalid_data, with the zone: sections that overlap, offsets that fall or leave the list, a cell with a face, or a
///          face with a point or cell, that is not there; in any zone coordinates, a field or elements that cannot be read, or are fewer than the zone needs
/// Cost     reads the sections of faces, of other zones a few nodes
Result<std::vector<CgnsFaceZone>> check_cgns_faces(const std::string& path);

/// The fields on cells of a zone at a step, which VTK's reader refuses where it has polygons.
///
/// `steps`   where the zone has as many solutions on cells, each is one step; else all are taken, of equal names the first
/// Errors    invalid_data: no values of 32 or 64 bits, another number of them
Result<std::vector<Field>> cgns_cell_fields(const std::string& path, const std::string& zone, std::size_t step,
                                            std::size_t steps);

} // namespace isotet::io::vtk
