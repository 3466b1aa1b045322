// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/vtk_xml/document.hpp"

#include <algorithm>
#include <array>
#include <span>

#include <fmt/core.h>

#include "base/errors.hpp"
#include "io/files/pace.hpp"
#include "io/files/text_scanner.hpp"
#include "io/vtk_xml/outline.hpp"

namespace isotet::io::vtk_xml {
namespace {

constexpr std::size_t max_components = 1U << 20U;
constexpr std::size_t tail_bytes = 4096;

struct TypeName {
    std::string_view name;
    ScalarType type;
};
constexpr std::array type_names{TypeName{"Int8", ScalarType::int8},       TypeName{"UInt8", ScalarType::uint8},
                                TypeName{"Int16", ScalarType::int16},     TypeName{"UInt16", ScalarType::uint16},
                                TypeName{"Int32", ScalarType::int32},     TypeName{"UInt32", ScalarType::uint32},
                                TypeName{"Int64", ScalarType::int64},     TypeName{"UInt64", ScalarType::uint64},
                                TypeName{"Float32", ScalarType::float32}, TypeName{"Float64", ScalarType::float64},
                                TypeName{"vtkIdType", ScalarType::int64}, TypeName{"Bit", ScalarType::uint8}};

bool same_word(std::string_view a, std::string_view b) {
    const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; };
    return std::ranges::equal(a, b, {}, lower, lower);
}

/// Where the appended data ends: at its end tag, which must be there as that of the file.
Result<std::size_t> end_of_data(const ByteSource& source) {
    Scratch scratch;
    const std::size_t from = source.size() - std::min(source.size(), tail_bytes);
    const auto tail = source.view(from, source.size() - from, scratch);
    if (!tail) return tail.error();
    const auto file = tail->rfind("</VTKFile");
    if (file == std::string_view::npos)
        return invalid_data(
            fmt::format("the file ends after {} bytes without </VTKFile>: it is cut short", source.size()));
    const auto data = tail->rfind("</AppendedData", file);
    return from + (data == std::string_view::npos ? file : data);
}

Result<void> find_appended(Document& document, std::size_t behind_tag) {
    const auto encoding =
        std::string_view(document.tree.child("VTKFile").child("AppendedData").attribute("encoding").value());
    document.appended_raw = same_word(encoding, "raw");
    if (!document.appended_raw && !encoding.empty() && !same_word(encoding, "base64")) // VTK takes none for base64
        return invalid_data(fmt::format("the encoding {} is not raw or base64", in_quotes(encoding)));
    const auto end = end_of_data(document.source);
    if (!end) return end.error();
    Scratch scratch;
    const std::size_t most = std::min(tail_bytes, std::max(*end, behind_tag) - behind_tag);
    const auto start = document.source.view(behind_tag, most, scratch);
    if (!start) return start.error();
    const auto underscore = start->find_first_not_of(" \t\r\n");
    if (underscore == std::string_view::npos || (*start)[underscore] != '_')
        return invalid_data("the appended data does not start with an underscore");
    document.appended = {behind_tag + underscore + 1, *end};
    document.appended_left = document.appended.size();
    return {};
}

Result<void> take_root(Document& document, const pugi::xml_node& root) {
    if (!root) {
        const char* const first = document.tree.first_child().name();
        return invalid_data(fmt::format("the first element is {}, not VTKFile", in_quotes(first)));
    }
    document.type = root.attribute("type").value();
    for (const auto& child : root.children())
        if (document.type.empty() && child.type() == pugi::node_element) document.type = child.name();
    const std::string_view order = root.attribute("byte_order").as_string("LittleEndian"),
                           header = root.attribute("header_type").as_string("UInt32"),
                           compressor = root.attribute("compressor").value();
    const bool is_big = same_word(order, "BigEndian");
    if (!is_big && !same_word(order, "LittleEndian"))
        return invalid_data(fmt::format("the byte order {} is not known", in_quotes(order)));
    if (header != "UInt32" && header != "UInt64")
        return invalid_data(fmt::format("the header type {} is not UInt32 or UInt64", in_quotes(header)));
    const auto codec = codec_of(compressor);
    if (!codec) return invalid_data(fmt::format("the compressor {} is not known", in_quotes(compressor)));
    document.order = is_big ? std::endian::big : std::endian::little;
    document.wide_header = header == "UInt64";
    document.codec = *codec;
    return {};
}

Error wrong(std::string_view name, std::string_view what) {
    return invalid_data(fmt::format("the array {}: {}", in_quotes(name), what));
}

Result<void> place_appended(const Document& document, const pugi::xml_node& element, DataArray& array) {
    const std::string_view stated = element.attribute("offset").value();
    std::uint64_t offset = 0;
    if (!parse_number(without_blanks(stated), offset))
        return wrong(array.name, fmt::format("its offset is {}, not a number", in_quotes(stated)));
    if (offset > document.appended.size())
        return wrong(array.name, fmt::format("offset {} lies behind the appended data, which has {} bytes", offset,
                                             document.appended.size()));
    array.place = {document.appended.begin + static_cast<std::size_t>(offset), document.appended.end};
    array.form = document.appended_raw ? DataArray::Form::raw : DataArray::Form::base64;
    return {};
}

/// Of a symmetric tensor whose components have names.
std::optional<TensorOrder> stated_order(const pugi::xml_node& element, std::size_t components) {
    std::array<std::string, 6> names;
    if (components != names.size()) return std::nullopt;
    for (std::size_t i = 0; i < names.size(); ++i)
        names[i] = element.attribute(fmt::format("ComponentName{}", i).c_str()).value();
    return order_of_names(names);
}

/// The text of an array, which comments, CDATA and keys of VTK may cut into several.
Result<void> place_inside(const Document& document, const pugi::xml_node& element, DataArray& array) {
    std::vector<Range> parts;
    for (const auto& child : element.children()) {
        if (child.type() != pugi::node_pcdata) continue;
        TextScanner places(child.value()); // of outline_of()
        for (Range part; places.number(part.begin) && places.number(part.end);) parts.push_back(part);
    }
    if (parts.size() > 1) {
        std::vector<Range> filled;
        for (const Range& part : parts) {
            const auto blank = is_blank(document.source, part);
            if (!blank) return blank.error();
            if (!*blank) filled.push_back(part);
        }
        parts = std::move(filled);
    }
    if (parts.size() < 2) {
        if (!parts.empty()) array.place = parts.front();
        return {};
    }
    std::string text;
    Scratch scratch;
    for (const Range& part : parts) {
        const auto view = document.source.view(part.begin, part.size(), scratch);
        if (!view) return view.error();
        text += *view;
    }
    array.place = {0, text.size()};
    array.text = std::make_shared<const std::string>(std::move(text));
    return {};
}

} // namespace

Result<bool> is_blank(const ByteSource& source, Range place) {
    Scratch scratch;
    constexpr std::size_t window = std::size_t{1} << 16;
    for (std::size_t at = place.begin; at < place.end; at += window) {
        const auto view = source.view(at, std::min(window, place.end - at), scratch);
        if (!view) return view.error();
        if (!std::ranges::all_of(*view, is_space)) return false;
    }
    return true;
}

Result<Document> open_document(const ByteSource& source, const Progress& progress) {
    auto outline = outline_of(source, progress);
    if (!outline) return outline.error();
    Document document(source);
    const auto parsed = document.tree.load_buffer(outline->text.data(), outline->text.size(), pugi::parse_default);
    if (!parsed) {
        if (parsed.status == pugi::status_end_element_mismatch && !outline->ended)
            return invalid_data("the file ends before </VTKFile>");
        return invalid_data(fmt::format("broken XML near byte {}: {}",
                                        outline->position_of(static_cast<std::size_t>(parsed.offset)),
                                        parsed.description()));
    }
    if (auto taken = take_root(document, document.tree.child("VTKFile")); !taken) return taken.error();
    if (outline->appended) {
        if (auto found = find_appended(document, *outline->appended); !found) return found.error();
    }
    return document;
}

Result<std::optional<DataArray>> describe_array(const Document& document, const pugi::xml_node& element) {
    DataArray array;
    array.name = element.attribute("Name").value();
    const std::string_view tag = element.name(), type = element.attribute("type").value();
    if (tag != "DataArray" && tag != "Array")
        return invalid_data(fmt::format("an element {} where an array should be", in_quotes(tag)));
    if (type == "String") return std::optional<DataArray>();
    const std::span<const TypeName> all = type_names; // an array's iterator is a pointer in some libraries only
    const auto known = std::ranges::find(all, type, &TypeName::name);
    if (known == all.end())
        return wrong(array.name, fmt::format("its type is {}, which is not known", in_quotes(type)));
    array.type = known->type;
    array.bits = type == "Bit";
    const std::string_view components = without_blanks(element.attribute("NumberOfComponents").value());
    const bool stated = !components.empty() && components != "0";
    if (stated &&
        (!parse_number(components, array.components) || array.components == 0 || array.components > max_components))
        return wrong(array.name,
                     fmt::format("it has {} components, not 1 to {}", in_quotes(components), max_components));
    array.order = stated_order(element, array.components);
    const std::string_view form = element.attribute("format").value();
    if (same_word(form, "appended")) {
        if (auto placed = place_appended(document, element, array); !placed) return placed.error();
        return std::optional(std::move(array));
    }
    const bool binary = same_word(form, "binary");
    if (!binary && !form.empty() && !same_word(form, "ascii"))
        return wrong(array.name, fmt::format("its format is {}, not ascii, binary or appended", in_quotes(form)));
    array.inside = true;
    array.form = binary ? DataArray::Form::base64 : DataArray::Form::ascii;
    if (auto placed = place_inside(document, element, array); !placed) return placed.error();
    return std::optional(std::move(array));
}

Result<std::uint64_t> count_of(const pugi::xml_node& element, const char* attribute,
                               std::optional<std::uint64_t> otherwise) {
    const pugi::xml_attribute stated = element.attribute(attribute);
    std::uint64_t count = 0;
    if (!stated && otherwise) return *otherwise;
    if (!stated) return invalid_data(fmt::format("a {} has no {}", element.name(), attribute));
    if (!parse_number(without_blanks(stated.value()), count))
        return invalid_data(fmt::format("{} is {}, not a count", attribute, in_quotes(stated.value())));
    return count;
}

} // namespace isotet::io::vtk_xml
