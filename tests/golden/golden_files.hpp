// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The real grids of data/, and the fields that are contoured of each.
#pragma once

#include <ostream>
#include <string>
#include <vector>

#include <isotet/grid.hpp>
#include <isotet/read.hpp>

#include "support/places.hpp"

namespace isotet::test {

struct GoldenFile {
    const char* path;       ///< below data/
    bool reader_process = false; ///< read with ISOTET_IO only

    friend void PrintTo(const GoldenFile& file, std::ostream* out) { *out << file.path; }
};

inline constexpr GoldenFile golden_files[] = {
    {"msh/inclusions_v22_ascii.msh"},
    {"msh/inclusions_v41_ascii.msh"},
    {"msh/inclusions_v41_binary.msh"},
    {"msh/table_v22_binary_elementdata.msh"},
    {"medit/cube_sphere_26k.meshb"},
    {"tetgen/ellipsoid_16k.node"},
    {"gocad/geomodel3d_tsolid.so"},
    {"vtu/artery_flow_tet_wedge.vtu"},
    {"vtu/wall_distance_point.vtu"},
    {"vtu/two_phase_box_tets_dup_points.vtu"},
    {"vtu/patch_antenna_efield.vtu"},
    {"vtu/stokes_channel_tets.vtu"},
    {"vtu/all_dims_tets_lzma.vtu"},
    {"vtu/polyhedron_two_pieces.vtu"},
    {"pvtu/monodomain/monodomain3d.pvtu"},
    {"vtk/lox_post_pressure.vtk"},
    {"vtk/lox_post_no_data.vtk"},
    {"vtk/tetra_mixed_orientation_int.vtk"},
    {"vtk/ugridex_all_kinds.vtk"},
    {"exodus/tension_tets_stress_3steps.e", true},
    {"exodus/mixed_blocks_hdf5.exo", true},
    {"cgns/wall_distance_adf.cgns", true},
    {"cgns/wall_distance_hdf5.cgns", true},
    {"vtkhdf/can_hex.hdf", true},
    {"avs_ucd/tet_attributes.inp", true},
    {"xdmf/no_checkpoint.xdmf", true},
    {"xdmf/tet4_vertex.xmf", true},
};

inline Result<ReadResult> read_golden(const std::string& path) {
    return read(source_folder().string() + "/data/" + path);
}

/// Up to three point fields (the first component of vectors), the first cell field, averaged, and two coordinates.
inline std::vector<std::string> fields_to_contour(const Grid& grid) {
    std::vector<std::string> names;
    for (const Field& field : grid.point_fields)
        if (names.size() < 3) names.push_back(field.values.components() == 1 ? field.name : field.name + ":0");
    for (const Field& field : grid.cell_fields) {
        if (field.values.components() != 1) continue;
        names.push_back(field.name);
        break;
    }
    names.insert(names.end(), {"x", "z"});
    return names;
}

} // namespace isotet::test
