// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The DataArray elements of VTK's XML files: where their bytes are, and the scalars in them.
#pragma once

#include <bit>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <isotet/array.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>

#include "io/own/surface_xml.hpp"

namespace isotet::io {

/// A DataArray as the header tells of it.
struct XmlArray {
    std::string name;
    ScalarType type = ScalarType::float32;
    std::size_t components = 1;
    enum class Form : std::uint8_t { ascii, binary, appended } form = Form::ascii;
    std::uint64_t offset = 0; ///< of the appended block
    std::string_view text;    ///< inline content
};

/// What holds for all arrays of a file.
struct XmlEncoding {
    std::endian order = std::endian::little;
    bool wide_header = false;  ///< block sizes are UInt64, else UInt32
    bool appended_raw = false; ///< else base64
    std::string_view appended; ///< from behind the underscore
};

/// Nothing for arrays of a type that is no scalar (String, Bit): they are left out.
Result<std::optional<XmlArray>> describe_array(const XmlTag& tag, std::string_view text);

/// The scalars; their number is a multiple of the components.
///
/// Errors   invalid_data: less data than announced, or no numbers; cancelled
Result<Array> load_array(const XmlArray& array, const XmlEncoding& encoding, const Progress& progress);

} // namespace isotet::io
