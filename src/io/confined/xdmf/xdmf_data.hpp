// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <pugixml.hpp>

#include <isotet/array.hpp>
#include <isotet/read.hpp>
#include <isotet/result.hpp>

#include "io/confined/hdf5/hdf5_array.hpp"
#include "io/confined/xdmf/xdmf_document.hpp"

namespace isotet::io::confined {

/// Whole numbers of an attribute: Dimensions="10 3". Nothing where there are none, or something else.
std::optional<std::vector<std::uint64_t>> whole_numbers(std::string_view text);

/// Reads DataItems: Format XML, HDF (through the HDF5 library) and Binary; ItemType Uniform, HyperSlab, Coordinates and
/// Function; References.
class XdmfData {
public:
    XdmfData(const XdmfDocument& document, bool allow_outside) : document_(document), allow_outside_(allow_outside) {}

    /// The values of a DataItem, or only their type and shape. Those of a Function are float64.
    Result<ShapedValues> read(pugi::xml_node item, Depth depth) const { return read_nested(item, depth, 0); }

    /// The same; integers of 64 bits may be int32 where all fit.
    Result<ShapedValues> read_indices(pugi::xml_node item, Depth depth) const {
        return read_nested(item, depth, 0, HdfNumbers::indices);
    }

private:
    Result<ShapedValues> read_nested(pugi::xml_node item, Depth depth, int level,
                                     HdfNumbers numbers = HdfNumbers::as_stored) const;
    Result<ShapedValues> read_uniform(pugi::xml_node item, Depth depth, HdfNumbers numbers) const;
    Result<ShapedValues> read_slab(pugi::xml_node item, Depth depth, int level) const;
    Result<ShapedValues> read_coordinates(pugi::xml_node item, Depth depth, int level) const;
    Result<ShapedValues> read_function(pugi::xml_node item, Depth depth, int level) const;
    Result<ShapedValues> read_xml(pugi::xml_node item, ScalarType type, Depth depth) const;
    Result<Array> read_binary(pugi::xml_node item, ScalarType type, std::uint64_t count) const;
    Result<std::vector<std::uint64_t>> read_places(pugi::xml_node item, int level) const;
    Result<std::string> file_named(pugi::xml_node item, std::string_view name) const;
    Error failed(pugi::xml_node item, std::string_view what) const;

    const XdmfDocument& document_;
    bool allow_outside_;
};

} // namespace isotet::io::confined
