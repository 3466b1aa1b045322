// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The grids of an XDMF file, sorted by time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <pugixml.hpp>

#include <isotet/read.hpp>
#include <isotet/result.hpp>

#include "io/confined/xdmf/xdmf_data.hpp"
#include "io/confined/xdmf/xdmf_document.hpp"

namespace isotet::io::confined {

/// A uniform grid of the file.
struct XdmfGrid {
    pugi::xml_node node;
    std::string name; ///< that of its series or its own, behind those of the collections it is in: "rotor/blade"
};

/// The grids of one time.
struct XdmfStep {
    std::optional<double> time;
    std::vector<std::uint32_t> grids; ///< places in XdmfSteps::grids
};

struct XdmfSteps {
    std::vector<XdmfGrid> grids;
    std::vector<XdmfStep> steps; ///< one at least
    std::vector<LeftOut> left_out;
};

/// Grids beside each other, in a domain or in a spatial collection, with times of their own make steps together: at each
/// time that one of them has those that have it, and those without a time.
///
/// Errors   invalid_data: no grid, grids nested without end, references to nothing
Result<XdmfSteps> sort_by_time(const std::string& path, const XdmfDocument& document, const XdmfData& data);

} // namespace isotet::io::confined
