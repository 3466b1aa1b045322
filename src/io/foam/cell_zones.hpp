// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Named sets of cells of an OpenFOAM mesh: rotors, porous parts.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <isotet/result.hpp>

#include "io/foam/case_files.hpp"
#include "io/foam/mesh.hpp"

namespace isotet::io::foam {

/// Zones may overlap, and need not cover the mesh.
struct CellZone {
    std::string name;
    std::uint64_t count = 0;
    std::vector<std::int32_t> cells; ///< none is below 0; empty where they were not asked for
};

/// Zones up to the first broken one.
struct CellZones {
    std::vector<CellZone> zones;
    std::optional<Error> fault; ///< why the rest was not read
};

/// What the file cellZones in the folder of a polyMesh has; nothing where there is no such file.
///
/// `wanted` zones whose cells are read
/// Faults   invalid_data: broken or cut short, which says file, what and where; as CaseFiles::open()
CellZones read_cell_zones(const CaseFiles& files, const std::string& folder, std::span<const std::string> wanted);

/// A mark for each cell of the whole mesh: 0 in one of the zones, 1 elsewhere.
///
/// `places`  of the parts
/// Errors   the fault of a file in which not all zones were found; invalid_data: a zone has a cell that the mesh has not
Result<std::vector<std::uint8_t>> cells_outside(std::span<const std::string> zones, const CaseFiles& files,
                                                const std::vector<MeshPlace>& places, const WholeMesh& whole);

} // namespace isotet::io::foam
