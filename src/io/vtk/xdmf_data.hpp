// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <pugixml.hpp>

#include <isotet/array.hpp>
#include <isotet/read.hpp>
#include <isotet/result.hpp>

#include "io/vtk/hdf5_array.hpp"
#include "io/vtk/xdmf_document.hpp"

namespace isotet::io::vtk {

/// Reads DataItems: Format XML, HDF (through the HDF5 library) and Binary; ItemType Uniform and HyperSlab; References.
class XdmfData {
public:
    XdmfData(std::string path, const XdmfDocument& document, bool allow_outside)
        : path_(std::move(path)), document_(document), allow_outside_(allow_outside) {}

    /// The values of a DataItem, or only their type and shape.
    Result<ShapedValues> read(pugi::xml_node item, Depth depth) const;

private:
    Result<ShapedValues> read_uniform(pugi::xml_node item, const Box& box, Depth depth) const;
    Result<ShapedValues> read_slab(pugi::xml_node item, Depth depth) const;
    Result<ShapedValues> read_hdf5(pugi::xml_node item, const Box& box, Depth depth) const;
    Result<Array> read_xml(pugi::xml_node item, ScalarType type, std::uint64_t count) const;
    Result<Array> read_binary(pugi::xml_node item, ScalarType type, std::uint64_t count) const;
    Error failed(std::string_view what) const;

    std::string path_;
    const XdmfDocument& document_;
    bool allow_outside_;
};

} // namespace isotet::io::vtk
