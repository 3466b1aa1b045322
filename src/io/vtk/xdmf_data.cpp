// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <bit>
#include <cstring>
#include <optional>

#include <fmt/core.h>

#include "io/own/text_scanner.hpp"
#include "io/own/escape.hpp"
#include "io/own/index_file.hpp"
#include "io/own/loaded.hpp"
#include "io/vtk/mapped_file.hpp"
#include "io/vtk/xdmf_data.hpp"

namespace isotet::io::vtk {
namespace {

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
    while (!text.empty() && is_space(text.back())) text.remove_suffix(1);
    return text;
}

/// NumberType (in version 1: Type, DataType) and Precision; float32 when the file says nothing.
std::optional<ScalarType> stated_type(pugi::xml_node item) {
    std::string_view type = item.attribute("NumberType").as_string();
    if (type.empty()) type = item.attribute("DataType").as_string("Float");
    const unsigned precision =
        item.attribute("Precision").as_uint(same_word(type, "Char") || same_word(type, "UChar") ? 1 : 4);
    if (same_word(type, "Float")) return precision == 8 ? ScalarType::float64 : ScalarType::float32;
    if (same_word(type, "Char")) return ScalarType::int8;
    if (same_word(type, "UChar")) return ScalarType::uint8;
    const bool is_signed = same_word(type, "Int");
    if (!is_signed && !same_word(type, "UInt")) return std::nullopt;
    switch (precision) {
    case 1: return is_signed ? ScalarType::int8 : ScalarType::uint8;
    case 2: return is_signed ? ScalarType::int16 : ScalarType::uint16;
    case 4: return is_signed ? ScalarType::int32 : ScalarType::uint32;
    case 8: return is_signed ? ScalarType::int64 : ScalarType::uint64;
    default: return std::nullopt;
    }
}

std::optional<std::vector<std::uint64_t>> stated_dimensions(pugi::xml_node item) {
    std::vector<std::uint64_t> result;
    TextScanner scanner(item.attribute("Dimensions").as_string());
    for (std::uint64_t length = 0; !scanner.at_end(); result.push_back(length))
        if (!scanner.number(length) || result.size() > 16) return std::nullopt;
    if (result.empty()) return std::nullopt;
    return result;
}

template <class T>
void swap_bytes(std::vector<T>& values) {
    for (T& value : values) {
        auto* bytes = reinterpret_cast<unsigned char*>(&value);
        std::reverse(bytes, bytes + sizeof value);
    }
}

} // namespace

Error XdmfData::failed(std::string_view what) const { return broken(path_, what); }

Result<ShapedValues> XdmfData::read(pugi::xml_node stated, Depth depth) const {
    const pugi::xml_node item = document_.resolve(stated);
    if (!item) return failed("a DataItem is missing, or refers to nothing");
    const std::string_view kind = item.attribute("ItemType").as_string("Uniform");
    if (same_word(kind, "HyperSlab")) return read_slab(item, depth);
    if (!same_word(kind, "Uniform"))
        return failed(fmt::format("a DataItem of type \"{}\" is not read: Uniform and HyperSlab are", escaped(kind)));
    return read_uniform(item, {}, depth);
}

Result<ShapedValues> XdmfData::read_uniform(pugi::xml_node item, const Box& box, Depth depth) const {
    const std::string_view format = item.attribute("Format").as_string("XML");
    if (same_word(format, "HDF")) return read_hdf5(item, box, depth);
    if (!box.count.empty()) return failed("a HyperSlab of something that is not in an HDF5 file is not read");
    const auto type = stated_type(item);
    const auto dimensions = stated_dimensions(item);
    if (!type || !dimensions) return failed("a DataItem without a number type and dimensions that are known");
    ShapedValues result{*dimensions, Array(*type, nullptr, 0, 1, nullptr)};
    if (depth == Depth::description) return result;
    auto values = same_word(format, "XML") ? read_xml(item, *type, result.count())
                  : same_word(format, "Binary")
                      ? read_binary(item, *type, result.count())
                      : Result<Array>(failed(fmt::format("a DataItem of format \"{}\" is not read", escaped(format))));
    if (!values) return values.error();
    result.values = std::move(*values);
    return result;
}

/// Two DataItems: start, stride and count of each dimension; and what they are taken from.
Result<ShapedValues> XdmfData::read_slab(pugi::xml_node item, Depth depth) const {
    const pugi::xml_node first = item.child("DataItem");
    const pugi::xml_node source = document_.resolve(first.next_sibling("DataItem"));
    if (!first || !source) return failed("a HyperSlab needs two DataItems");
    std::vector<std::uint64_t> numbers;
    TextScanner scanner(document_.resolve(first).text().as_string());
    for (std::uint64_t number = 0; !scanner.at_end() && numbers.size() <= 48; numbers.push_back(number))
        if (!scanner.number(number)) return failed("a HyperSlab whose start, stride and count are not whole numbers");
    if (numbers.empty() || numbers.size() % 3 != 0)
        return failed("a HyperSlab without start, stride and count for each dimension");
    const auto third = static_cast<std::ptrdiff_t>(numbers.size() / 3);
    const auto begin = numbers.begin();
    return read_uniform(
        source, {{begin, begin + third}, {begin + third, begin + 2 * third}, {begin + 2 * third, numbers.end()}},
        depth);
}

Result<Array> XdmfData::read_xml(pugi::xml_node item, ScalarType type, std::uint64_t count) const {
    const std::string_view text = item.text().as_string();
    if (count > text.size())
        return failed(fmt::format("a DataItem of {} values has {} characters", count, text.size()));
    return Array(type, nullptr, 0, 1, nullptr).visit([&](auto none) -> Result<Array> {
        using T = std::remove_const_t<typename decltype(none)::value_type>;
        std::vector<T> values(count);
        TextScanner scanner(text);
        for (std::uint64_t i = 0; i < count; ++i) {
            double real = 0;
            std::int64_t whole = 0;
            const bool read = std::is_floating_point_v<T> ? scanner.number(real) : scanner.number(whole);
            if (!read)
                return failed(
                    fmt::format("a DataItem of {} values has no number at place {}, {}", count, i, scanner.where()));
            values[i] = std::is_floating_point_v<T> ? static_cast<T>(real) : static_cast<T>(whole);
        }
        if (!scanner.at_end()) return failed(fmt::format("a DataItem has more than the {} values it states", count));
        return Array::own(std::move(values));
    });
}

Result<Array> XdmfData::read_binary(pugi::xml_node item, ScalarType type, std::uint64_t count) const {
    auto path = named_file(path_, trimmed(item.text().as_string()), allow_outside_);
    if (!path) return path.error();
    auto file = MappedFile::open(*path);
    if (!file) return file.error();
    const std::uint64_t seek = item.attribute("Seek").as_ullong(), size = file->text().size();
    if (seek > size || count > (size - seek) / size_of(type))
        return broken(*path,
                      fmt::format("{} values from byte {} are wanted, but the file has {} bytes", count, seek, size));
    const std::string_view endian = item.attribute("Endian").as_string("Native");
    const bool swap = same_word(endian, "Big")
                          ? std::endian::native != std::endian::big
                          : same_word(endian, "Little") && std::endian::native != std::endian::little;
    return Array(type, nullptr, 0, 1, nullptr).visit([&](auto none) -> Result<Array> {
        std::vector<std::remove_const_t<typename decltype(none)::value_type>> values(count);
        std::memcpy(values.data(), file->text().data() + seek, count * sizeof values[0]);
        if (swap) swap_bytes(values);
        return Array::own(std::move(values));
    });
}

/// "file.h5:/group/data set"
Result<ShapedValues> XdmfData::read_hdf5(pugi::xml_node item, const Box& box, Depth depth) const {
    const std::string_view text = trimmed(item.text().as_string());
    const auto colon = text.rfind(":/") != std::string_view::npos ? text.rfind(":/") : text.rfind(':');
    if (colon == std::string_view::npos || colon + 1 == text.size())
        return failed(fmt::format("\"{}\" does not name a file and a data set", escaped(text.substr(0, 80))));
    auto file = named_file(path_, text.substr(0, colon), allow_outside_);
    if (!file) return file.error();
    auto values = read_hdf5_array(*file, std::string(text.substr(colon + 1)), box, depth);
    if (!values) return values.error();
    if (const auto stated = stated_dimensions(item); stated && box.count.empty()) {
        const ShapedValues expected{*stated, Array()};
        if (expected.count() != values->count())
            return failed(fmt::format("\"{}\" has {} values, but {} are stated", escaped(text), values->count(),
                                      expected.count()));
    }
    return values;
}

} // namespace isotet::io::vtk
