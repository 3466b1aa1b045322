// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What a case has: times, regions, processors, and where the mesh of a time is.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <isotet/result.hpp>

#include "io/foam/case_files.hpp"
#include "io/foam/mesh.hpp"

namespace isotet::io::foam {

struct CaseLayout {
    std::vector<std::string> prefixes;                 ///< "" for a whole case, else "processor0/" and so on
    std::vector<std::pair<double, std::string>> times; ///< ascending, with the names of their folders
    std::vector<std::string> regions;                  ///< "" for the one without a name, the first
    std::vector<std::string> notes;

    bool has_several_regions() const { return regions.size() > 1; }
    /// The mesh in constant/polyMesh beside those of regions, which splitMeshRegions makes of it and leaves there.
    bool has_base_mesh() const { return has_several_regions() && regions.front().empty(); }
    /// Under which a region is chosen: no other can be called as the folder of the base mesh.
    std::string name_of(std::size_t region) const {
        return has_base_mesh() && region == 0 ? "polyMesh" : regions[region];
    }
};

/// The processor folders are read where the case's own folder has no mesh, or they have a later time.
///
/// Errors   invalid_data: no mesh, a processor folder that is missing
Result<CaseLayout> layout_of(const CaseFiles& files);

/// Where the mesh of a region is at a time: the latest one up to it.
Result<MeshPlace> mesh_place(const CaseFiles& files, const CaseLayout& layout, const std::string& prefix,
                             const std::string& region, std::size_t step);

} // namespace isotet::io::foam
