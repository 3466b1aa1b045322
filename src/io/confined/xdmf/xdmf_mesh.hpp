// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Points and cells of a grid of XDMF.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <pugixml.hpp>

#include <isotet/grid.hpp>
#include <isotet/result.hpp>

#include "io/confined/xdmf/xdmf_amr.hpp"
#include "io/confined/xdmf/xdmf_data.hpp"
#include "io/confined/xdmf/xdmf_document.hpp"
#include "io/confined/xdmf/xdmf_quadratic.hpp"

namespace isotet::io::confined {

/// An attribute that has an older name, too.
std::string_view attribute_of(pugi::xml_node node, const char* name, const char* older_name);

/// An XDMF file, open.
struct XdmfFile {
    const std::string& path;
    const XdmfDocument& document;
    const XdmfData& data;
};

/// What a Topology and a Geometry describe; for a description without their arrays.
struct XdmfMesh {
    std::uint64_t points = 0, cells = 0;
    std::uint64_t corners = 0; ///< at least, of cells that are listed
    ScalarType coordinates = ScalarType::float32;
    Grid grid = {};
    std::map<std::string, pugi::xml_node> fields = {}; ///< those that were read, by association and name
    std::optional<XdmfImage> image = {};               ///< where the points are evenly spaced, the axes those of space
    std::shared_ptr<const TetEdges> edges = nullptr;   ///< where fields have values on them, behind those at points
};

/// Errors   invalid_data: a type that is not read, numbers that do not fit together, as XdmfData::read()
Result<XdmfMesh> read_mesh(const XdmfFile& file, pugi::xml_node geometry, pugi::xml_node topology, Depth depth,
                           std::vector<std::string>& notes);

/// True for a topology of points, lines and surfaces alone.
bool is_flat(pugi::xml_node topology);

} // namespace isotet::io::confined
