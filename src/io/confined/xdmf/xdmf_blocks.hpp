// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Which grids of a time step of XDMF are on the same mesh.
#pragma once

#include <string>
#include <vector>

#include <pugixml.hpp>

#include <isotet/read.hpp>
#include <isotet/result.hpp>

#include "io/confined/xdmf/xdmf_mesh.hpp"
#include "io/confined/xdmf/xdmf_steps.hpp"

namespace isotet::io::confined {

/// Grids whose Topology and Geometry name the same data.
struct XdmfBlock {
    std::string name;
    pugi::xml_node geometry, topology;
    std::string points;                ///< equal where the geometries name the same data
    std::vector<pugi::xml_node> grids; ///< their attributes are fields of one grid
};

struct XdmfBlocks {
    std::vector<XdmfBlock> blocks; ///< in the order of the file
    std::vector<LeftOut> left_out;
};

/// The grids of a step. Left out: those that lack Geometry or Topology, and those without cells that have a
/// volume, where others have some.
///
/// Errors   invalid_data: no grid is left
Result<XdmfBlocks> blocks_of(const XdmfFile& file, const XdmfSteps& steps, const XdmfStep& step);

} // namespace isotet::io::confined
