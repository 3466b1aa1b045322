// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The mesh of an OpenFOAM case: faces between cells, from one polyMesh or from those of all processors.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <isotet/grid.hpp>
#include <isotet/result.hpp>

#include "io/foam/case_files.hpp"
#include "io/foam/scanner.hpp"

namespace isotet::io::foam {

/// Faces of the boundary, one after another.
struct Patch {
    std::string name, type;
    std::vector<std::string> groups;
    std::size_t first = 0, count = 0; ///< faces
};

/// A polyMesh. Everything is in range.
struct Mesh {
    std::vector<double> points; ///< three a point
    bool single = false;        ///< the file states float32
    Faces faces;
    std::vector<std::int32_t> owner, neighbour; ///< one a face; -1: no neighbour
    std::size_t cells = 0;
    std::vector<Patch> patches;

    std::size_t point_count() const noexcept { return points.size() / 3; }
};

/// Where the parts of a polyMesh are: folders in the case. A moving mesh has its points in a folder of their time.
struct MeshPlace {
    std::string points, faces;
};

/// Errors   file: a file is not there; invalid_data: broken or cut short, which says file, what and where
Result<Mesh> read_mesh(const CaseFiles& files, const MeshPlace& place);

/// One processor's part of a case, and which points and cells of the whole its own are.
struct Part {
    std::string prefix;         ///< "processor3/", or empty
    std::vector<Patch> patches; ///< faces of the whole
    std::size_t points = 0, cells = 0;
    std::vector<std::int32_t> point_numbers, cell_numbers; ///< of the whole; empty where this is the only part
};

struct WholeMesh {
    Mesh mesh;
    std::vector<Part> parts;
    std::vector<std::string> notes;
};

/// Makes one mesh of those of processors: points by pointProcAddressing, cells by cellProcAddressing where all have
/// it and it is a numbering, else by equal coordinates and one part after another.
Result<WholeMesh> join_meshes(const CaseFiles& files, std::vector<Mesh> meshes, const std::vector<MeshPlace>& places,
                              const std::vector<std::string>& prefixes, bool by_coordinates);

/// Tetrahedra, pyramids, wedges and hexahedra where the faces are theirs, in an order of corners that depends on point
/// numbers alone; polyhedra with their faces else. Frees owners and neighbours before cells take memory.
Cells cells_of(Mesh& mesh);

} // namespace isotet::io::foam
