// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/own/surface_xml_arrays.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include <fmt/core.h>

#include "io/own/byte_reader.hpp"
#include "io/own/pace.hpp"
#include "io/own/surface_base64.hpp"
#include "io/own/surface_scalars.hpp"

namespace isotet::io {
namespace {

constexpr std::size_t most_components = 1U << 20U;

struct TypeName {
    std::string_view name;
    ScalarType type;
};
constexpr std::array type_names{TypeName{"Int8", ScalarType::int8},       TypeName{"UInt8", ScalarType::uint8},
                                TypeName{"Int16", ScalarType::int16},     TypeName{"UInt16", ScalarType::uint16},
                                TypeName{"Int32", ScalarType::int32},     TypeName{"UInt32", ScalarType::uint32},
                                TypeName{"Int64", ScalarType::int64},     TypeName{"UInt64", ScalarType::uint64},
                                TypeName{"Float32", ScalarType::float32}, TypeName{"Float64", ScalarType::float64},
                                TypeName{"vtkIdType", ScalarType::int64}};

Error wrong(const XmlArray& array, std::string_view what) {
    return {ErrorCode::invalid_data, fmt::format("the array {}: {}", in_quotes(array.name), what)};
}

/// The size in front of a block.
std::optional<std::uint64_t> block_size(std::string_view bytes, const XmlEncoding& encoding) {
    ByteReader reader(bytes, encoding.order != std::endian::native);
    std::uint64_t size = 0;
    std::uint32_t narrow = 0;
    if (encoding.wide_header) return reader.read(size) ? std::optional(size) : std::nullopt;
    return reader.read(narrow) ? std::optional<std::uint64_t>(narrow) : std::nullopt;
}

Result<Array> decode_block(const XmlArray& array, std::string_view bytes, std::endian order) {
    const std::size_t tuple = array.components * size_of(array.type);
    if (bytes.size() % tuple != 0) {
        return wrong(array, fmt::format("{} bytes are no whole number of tuples of {} {}", bytes.size(),
                                        array.components, name_of(array.type)));
    }
    return decode_scalars(array.type, bytes, array.components, order);
}

Result<Array> load_raw(const XmlArray& array, const XmlEncoding& encoding) {
    const auto& appended = encoding.appended;
    if (array.offset > appended.size()) {
        return wrong(array, fmt::format("offset {} lies behind the appended data, which has {} bytes", array.offset,
                                        appended.size()));
    }
    const auto block = appended.substr(static_cast<std::size_t>(array.offset));
    const auto size = block_size(block, encoding);
    const std::size_t header = encoding.wide_header ? 8 : 4;
    if (!size || *size > block.size() - header) {
        return wrong(array,
                     fmt::format("{} bytes are announced, but only {} are left", size.value_or(header), block.size()));
    }
    return decode_block(array, block.substr(header, static_cast<std::size_t>(*size)), encoding.order);
}

Result<Array> load_base64(const XmlArray& array, const XmlEncoding& encoding, std::string_view text) {
    const std::size_t header = encoding.wide_header ? 8 : 4;
    const auto head = decode_base64(text, header);
    const auto size = head ? block_size(*head, encoding) : std::nullopt;
    if (!size) return wrong(array, "no base64 data where the size of the block should be");
    if (*size > text.size()) {
        return wrong(array, fmt::format("{} bytes are announced, but only {} characters are left", *size, text.size()));
    }
    const auto bytes = decode_base64(text, header + static_cast<std::size_t>(*size));
    if (!bytes || bytes->size() != header + *size) {
        return wrong(array, fmt::format("{} bytes are announced, but the base64 data ends before", *size));
    }
    return decode_block(array, std::string_view(*bytes).substr(header), encoding.order);
}

Result<Array> load_ascii(const XmlArray& array, const Progress& progress) {
    TextScanner scanner(array.text);
    return with_type(array.type, [&](auto zero) -> Result<Array> {
        std::vector<decltype(zero)> values;
        Pace pace(progress, array.text.size());
        while (!scanner.at_end()) {
            if (!read_scalar(scanner, zero)) {
                return wrong(array,
                             fmt::format("{} is not {}", in_quotes(scanner.rest().substr(0, 20)), name_of(array.type)));
            }
            values.push_back(zero);
            if (!pace.goes_on(scanner.position())) return Pace::cancelled();
        }
        if (values.size() % array.components != 0) {
            return wrong(
                array, fmt::format("{} numbers are no whole number of tuples of {}", values.size(), array.components));
        }
        return Array::own(std::move(values), array.components);
    });
}

} // namespace

Result<std::optional<XmlArray>> describe_array(const XmlTag& tag, std::string_view text) {
    XmlArray array;
    array.name = tag.get("Name");
    array.text = text;
    const auto type = tag.get("type");
    const auto known = std::ranges::find(type_names, type, &TypeName::name);
    if (known == type_names.end()) {
        if (type == "String" || type == "Bit") return std::optional<XmlArray>();
        return wrong(array, fmt::format("its type is {}, which is not known", in_quotes(type)));
    }
    array.type = known->type;
    const auto components = tag.get("NumberOfComponents", "1");
    if (!parse_number(components, array.components) || array.components == 0 || array.components > most_components) {
        return wrong(array, fmt::format("it has {} components, not 1 to {}", in_quotes(components), most_components));
    }
    const auto form = tag.get("format", "ascii");
    if (form == "appended") {
        array.form = XmlArray::Form::appended;
        if (!parse_number(tag.get("offset"), array.offset)) {
            return wrong(array, fmt::format("its offset is {}, not a number", in_quotes(tag.get("offset"))));
        }
    } else if (form == "binary") {
        array.form = XmlArray::Form::binary;
    } else if (form != "ascii") {
        return wrong(array, fmt::format("its format is {}, not ascii, binary or appended", in_quotes(form)));
    }
    return std::optional(std::move(array));
}

Result<Array> load_array(const XmlArray& array, const XmlEncoding& encoding, const Progress& progress) {
    if (progress.cancelled()) return Pace::cancelled();
    switch (array.form) {
    case XmlArray::Form::ascii: return load_ascii(array, progress);
    case XmlArray::Form::binary: return load_base64(array, encoding, array.text);
    case XmlArray::Form::appended: break;
    }
    if (encoding.appended_raw) return load_raw(array, encoding);
    if (array.offset > encoding.appended.size()) {
        return wrong(array, fmt::format("offset {} lies behind the appended data, which has {} characters",
                                        array.offset, encoding.appended.size()));
    }
    return load_base64(array, encoding, encoding.appended.substr(static_cast<std::size_t>(array.offset)));
}

} // namespace isotet::io
