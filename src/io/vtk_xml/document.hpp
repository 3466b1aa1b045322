// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The XML of a VTK file without its data: elements and attributes as a tree, and where the data of each array lies.
#pragma once

#include <bit>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <pugixml.hpp>

#include <isotet/array.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>

#include "io/files/byte_source.hpp"
#include "io/pieces/tensor_order.hpp"
#include "io/vtk_xml/codec.hpp"

namespace isotet::io::vtk_xml {

/// Positions in the file.
struct Range {
    std::size_t begin = 0, end = 0;
    std::size_t size() const noexcept { return end - begin; }
};

/// A VTKFile element.
struct Document {
    explicit Document(ByteSource bytes) : source(std::move(bytes)) {}

    ByteSource source;
    pugi::xml_document tree; ///< the text of an array is replaced by its place, "BEGIN END"
    std::string type;        ///< "UnstructuredGrid" and so on
    std::endian order = std::endian::little;
    bool wide_header = false; ///< sizes in front of blocks are UInt64, else UInt32
    Codec codec = Codec::none;
    bool appended_raw = false; ///< else base64
    Range appended;            ///< from behind the underscore
    /// Bytes that arrays may still have of it: with arrays that share their bytes a small file could fill any memory.
    std::uint64_t appended_left = 0;
    std::set<std::size_t> appended_begins; ///< of arrays that were found
    std::uint64_t shared_bytes = 0;        ///< of values of arrays that begin where an earlier one does
    std::vector<std::string> odd_lengths;  ///< arrays whose stated length is not that of their data
    std::vector<std::string> longer;       ///< arrays with more values than are announced, as they are told

    /// The element of the file's type.
    pugi::xml_node primary() const { return tree.child("VTKFile").child(type.c_str()); }
};

/// Reads everything up to the appended data.
///
/// Errors   invalid_data: not XML or no end tag, an unknown byte order, header type or compressor,
///          more than 64 MB of elements; file, machine, as ByteSource::read(); cancelled
Result<Document> open_document(const ByteSource& source, const Progress& progress);

/// A DataArray element.
struct DataArray {
    std::string name;
    ScalarType type = ScalarType::float32;
    std::size_t components = 1;
    enum class Form : std::uint8_t { ascii, base64, raw } form = Form::ascii;
    bool bits = false;   ///< of type Bit: eight to a byte; they become uint8
    bool inside = false; ///< inline, else appended
    std::optional<TensorOrder> order; ///< of its components in the file, where their names state another one than VTK's
    Range place;         ///< of its text, or from its block to the end of the appended data
    std::shared_ptr<const std::string> text; ///< where it stands in several places: these together, `place` is in it

    ByteSource source(const Document& document) const { return text ? ByteSource(std::string_view(*text)) : document.source; }
};

/// Whether there is nothing but white space.
Result<bool> is_blank(const ByteSource& source, Range place);

/// Nothing for arrays of strings. Formats are read in any case, no components or 0 are 1, as VTK does.
///
/// Errors   invalid_data: no name of a type or format, no number of components, an offset outside the appended data
Result<std::optional<DataArray>> describe_array(const Document& document, const pugi::xml_node& element);

/// An attribute that is a count; `otherwise` where it is missing.
Result<std::uint64_t> count_of(const pugi::xml_node& element, const char* attribute,
                               std::optional<std::uint64_t> otherwise = {});

} // namespace isotet::io::vtk_xml
