// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Attributes and sets of XDMF as fields.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <pugixml.hpp>

#include <isotet/read.hpp>
#include <isotet/result.hpp>

#include "io/confined/xdmf/xdmf_mesh.hpp"
#include "io/pieces/loaded.hpp"

namespace isotet::io::confined {

/// An Attribute or a Set of a grid, before its values are read.
struct XdmfField {
    pugi::xml_node node; ///< null where it refers to nothing
    std::string name;
    std::optional<Association> association; ///< nothing: of the whole grid, of faces, of edges
};

/// The attributes and sets of a grid. A time behind a slash in a name, as some versions of dolfinx write it ("u/0.5"), is not part
/// of the name.
std::vector<XdmfField> fields_of(const XdmfDocument& document, pugi::xml_node grid, std::optional<double> time);

/// Reads the fields of one mesh after another.
class XdmfFieldReader {
public:
    XdmfFieldReader(const XdmfFile& file, const ReadOptions& options) : file_(file), options_(options) {}

    /// Announces the field, and where it is wanted puts its values into the grid of the mesh; or lists it as left out.
    ///
    /// Errors   out_of_memory
    Result<void> read(const XdmfField& field, XdmfMesh& mesh, Depth depth, Loaded& loaded);

private:
    Result<void> read_values(const XdmfField& field, XdmfMesh& mesh, Depth depth, Loaded& loaded);

    const XdmfFile& file_;
    const ReadOptions& options_;
};

} // namespace isotet::io::confined
