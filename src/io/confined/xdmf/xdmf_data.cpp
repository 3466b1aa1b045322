// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/confined/xdmf/xdmf_data.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <type_traits>
#include <utility>

#include <fmt/core.h>

#include "io/files/text_scanner.hpp"
#include "io/files/escape.hpp"
#include "io/files/index_file.hpp"
#include "io/pieces/loaded.hpp"
#include "io/confined/mapped_file.hpp"
#include "io/confined/xdmf/xdmf_function.hpp"
#include "io/confined/xdmf/xdmf_heavy.hpp"

namespace isotet::io::confined {
namespace {

constexpr int deepest_item = 16;

struct NamedNumber {
    std::string_view name;
    char kind; ///< i: signed, u: unsigned, f: floating
    unsigned precision;
};
constexpr NamedNumber number_types[] = {
    {"Float", 'f', 4}, {"Double", 'f', 8}, {"Int", 'i', 4},    {"UInt", 'u', 4}, {"Char", 'i', 1},
    {"UChar", 'u', 1}, {"Short", 'i', 2},  {"UShort", 'u', 2}, {"Long", 'i', 8}, {"ULong", 'u', 8},
};

/// NumberType (in version 1: Type, DataType) and Precision; float32 when the file says nothing.
std::optional<ScalarType> stated_type(pugi::xml_node item) {
    std::string_view name = item.attribute("NumberType").as_string();
    if (name.empty()) name = item.attribute("DataType").as_string("Float");
    for (const NamedNumber& type : number_types) {
        if (!same_word(type.name, name)) continue;
        const bool is_signed = type.kind == 'i';
        switch (const unsigned precision = item.attribute("Precision").as_uint(type.precision); precision) {
        case 1:
            if (type.kind == 'f') return std::nullopt;
            return is_signed ? ScalarType::int8 : ScalarType::uint8;
        case 2:
            if (type.kind == 'f') return std::nullopt;
            return is_signed ? ScalarType::int16 : ScalarType::uint16;
        case 4: return type.kind == 'f' ? ScalarType::float32 : is_signed ? ScalarType::int32 : ScalarType::uint32;
        case 8: return type.kind == 'f' ? ScalarType::float64 : is_signed ? ScalarType::int64 : ScalarType::uint64;
        default: return std::nullopt;
        }
    }
    return std::nullopt;
}

std::optional<std::vector<std::uint64_t>> stated_dimensions(pugi::xml_node item) {
    return whole_numbers(item.attribute("Dimensions").as_string());
}

template <class T>
void swap_bytes(std::vector<T>& values) {
    for (T& value : values) {
        auto* bytes = reinterpret_cast<unsigned char*>(&value);
        std::reverse(bytes, bytes + sizeof value);
    }
}

/// The values at these places, one after another. Places are in range.
Array values_at(const Array& from, const std::vector<std::uint64_t>& places) {
    return from.visit([&]<class T>(std::span<const T> values) {
        std::vector<T> out(places.size());
        for (std::size_t i = 0; i < places.size(); ++i) out[i] = values[places[i]];
        return Array::own(std::move(out));
    });
}

bool lies_in(const Box& box, const std::vector<std::uint64_t>& dimensions) {
    bool inside = box.count.size() == dimensions.size();
    for (std::size_t axis = 0; inside && axis < dimensions.size(); ++axis)
        inside = box.count[axis] != 0 && box.stride[axis] != 0 && box.start[axis] < dimensions[axis] &&
                 box.count[axis] - 1 <= (dimensions[axis] - 1 - box.start[axis]) / box.stride[axis];
    return inside;
}

/// Places in values of these dimensions, in which the box lies; last dimension fastest.
std::vector<std::uint64_t> places_of(const Box& box, const std::vector<std::uint64_t>& dimensions) {
    std::vector<std::uint64_t> places{0};
    for (std::size_t axis = 0; axis < dimensions.size(); ++axis) {
        std::vector<std::uint64_t> finer;
        finer.reserve(places.size() * box.count[axis]);
        for (const std::uint64_t place : places)
            for (std::uint64_t i = 0; i < box.count[axis]; ++i)
                finer.push_back(place * dimensions[axis] + box.start[axis] + i * box.stride[axis]);
        places = std::move(finer);
    }
    return places;
}

bool is_hdf(std::string_view format) { return same_word(format, "HDF") || same_word(format, "HDF5"); }

bool is_heavy(pugi::xml_node item) {
    return same_word(item.attribute("ItemType").as_string("Uniform"), "Uniform") &&
           is_hdf(item.attribute("Format").as_string());
}

} // namespace

std::optional<std::vector<std::uint64_t>> whole_numbers(std::string_view text) {
    std::vector<std::uint64_t> result;
    TextScanner scanner(text);
    for (std::uint64_t number = 0; !scanner.at_end(); result.push_back(number))
        if (!scanner.number(number) || result.size() > 64) return std::nullopt;
    if (result.empty()) return std::nullopt;
    return result;
}

Error XdmfData::failed(pugi::xml_node item, std::string_view what) const {
    return broken(document_.file_of(item), what);
}

/// Beside the file that the item is in, else beside the one that was opened: some programs copy a mesh from a subfolder.
Result<std::string> XdmfData::file_named(pugi::xml_node item, std::string_view name) const {
    auto beside = named_file(document_.file_of(item), name, allow_outside_);
    if (beside || beside.error().code != ErrorCode::file) return beside;
    auto beside_first = named_file(document_.first_file(), name, allow_outside_);
    return beside_first ? std::move(beside_first) : std::move(beside);
}

Result<ShapedValues> XdmfData::read_nested(pugi::xml_node stated, Depth depth, int level, HdfNumbers numbers) const {
    const pugi::xml_node item = document_.resolve(stated);
    if (!item) return failed(stated, "a DataItem is missing, or refers to nothing");
    if (level > deepest_item) return failed(item, fmt::format("DataItems are nested more than {} deep", deepest_item));
    if (const std::string_view stated_size = item.attribute("Dimensions").as_string();
        !stated_size.empty() && !stated_dimensions(item))
        return failed(item, fmt::format("a DataItem has the Dimensions \"{}\"", escaped(stated_size.substr(0, 80))));
    const std::string_view kind = item.attribute("ItemType").as_string("Uniform");
    if (same_word(kind, "Uniform")) return read_uniform(item, depth, numbers);
    if (same_word(kind, "HyperSlab")) return read_slab(item, depth, level + 1);
    if (same_word(kind, "Coordinates") || same_word(kind, "Coordinate"))
        return read_coordinates(item, depth, level + 1);
    if (same_word(kind, "Function")) return read_function(item, depth, level + 1);
    return failed(item, fmt::format("a DataItem of type \"{}\" is not read: Uniform, HyperSlab, Coordinates and "
                                    "Function are",
                                    escaped(kind)));
}

Result<ShapedValues> XdmfData::read_uniform(pugi::xml_node item, Depth depth, HdfNumbers numbers) const {
    const std::string_view format = item.attribute("Format").as_string("XML");
    const auto dimensions = stated_dimensions(item);
    if (is_hdf(format)) {
        auto values = read_heavy(
            document_.file_of(item), text_of(item), [&](std::string_view name) { return file_named(item, name); }, {},
            depth, numbers);
        if (!values || !dimensions) return values;
        const ShapedValues expected{*dimensions, Array()};
        if (expected.count() != values->count())
            return failed(item, fmt::format("\"{}\" has {} values, but {} are stated", escaped(text_of(item)),
                                            values->count(), expected.count()));
        if (expected.count() != 0) values->dimensions = *dimensions;
        return values;
    }
    const auto type = stated_type(item);
    if (!type)
        return failed(item, fmt::format("a DataItem of number type \"{}{}\" of {} bytes is not read",
                                        escaped(item.attribute("NumberType").as_string()),
                                        escaped(item.attribute("DataType").as_string()),
                                        escaped(item.attribute("Precision").as_string("-"))));
    if (same_word(format, "XML")) return read_xml(item, *type, depth);
    if (!same_word(format, "Binary"))
        return failed(item,
                      fmt::format("a DataItem of format \"{}\" is not read: XML, HDF and Binary are", escaped(format)));
    if (!dimensions) return failed(item, "a DataItem of format Binary has no Dimensions");
    ShapedValues result{*dimensions, Array(*type, nullptr, 0, 1, nullptr)};
    if (depth == Depth::description) return result;
    auto values = read_binary(item, *type, result.count());
    if (!values) return values.error();
    result.values = *std::move(values);
    return result;
}

Result<ShapedValues> XdmfData::read_xml(pugi::xml_node item, ScalarType type, Depth depth) const {
    const auto dimensions = stated_dimensions(item);
    ShapedValues result{dimensions.value_or(std::vector<std::uint64_t>()), Array(type, nullptr, 0, 1, nullptr)};
    if (dimensions && depth == Depth::description) return result;
    const std::string text = text_of(item);
    const std::uint64_t count = dimensions ? result.count() : 0;
    if (count > text.size())
        return failed(item, fmt::format("a DataItem of {} values has {} characters", count, text.size()));
    auto read = Array(type, nullptr, 0, 1, nullptr).visit([&]<class T>(std::span<const T>) -> Result<Array> {
        std::vector<T> values;
        values.reserve(count);
        TextScanner scanner(text);
        while (dimensions ? values.size() < count : !scanner.at_end()) {
            std::conditional_t<std::is_floating_point_v<T>, double, T> value{};
            if (!scanner.number(value))
                return failed(item, fmt::format("a DataItem of {} values has no number of its type at place {}, {}",
                                                count, values.size(), scanner.where()));
            values.push_back(static_cast<T>(value));
        }
        if (!scanner.at_end())
            return failed(item, fmt::format("a DataItem has more than the {} values it states", count));
        return Array::own(std::move(values));
    });
    if (!read) return read.error();
    result.values = *std::move(read);
    if (!dimensions) result.dimensions = {result.values.size()};
    if (depth == Depth::description) result.values = Array(type, nullptr, 0, 1, nullptr);
    return result;
}

Result<Array> XdmfData::read_binary(pugi::xml_node item, ScalarType type, std::uint64_t count) const {
    if (const std::string_view packed = item.attribute("Compression").as_string("Raw"); !same_word(packed, "Raw"))
        return failed(item,
                      fmt::format("a binary DataItem with compression \"{}\" is not read: Raw is", escaped(packed)));
    auto path = file_named(item, text_of(item));
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
    return Array(type, nullptr, 0, 1, nullptr).visit([&]<class T>(std::span<const T>) -> Result<Array> {
        std::vector<T> values(count);
        if (count > 0) std::memcpy(values.data(), file->text().data() + seek, count * sizeof values[0]);
        if (swap) swap_bytes(values);
        return Array::own(std::move(values));
    });
}

/// The whole numbers of the first DataItem in another one: places in what the second has.
Result<std::vector<std::uint64_t>> XdmfData::read_places(pugi::xml_node item, int level) const {
    const auto read = read_nested(item, Depth::arrays, level);
    if (!read) return read.error();
    std::vector<std::uint64_t> numbers(read->values.size());
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        const double value = read->values.at(i);
        if (!(value >= 0 && value < 0x1p52) || value != static_cast<double>(static_cast<std::uint64_t>(value)))
            return failed(item, fmt::format("{} is not a whole number from 0: places in another DataItem are", value));
        numbers[i] = static_cast<std::uint64_t>(value);
    }
    return numbers;
}

/// Two DataItems: start, stride and count of each dimension; and what they are taken from.
Result<ShapedValues> XdmfData::read_slab(pugi::xml_node item, Depth depth, int level) const {
    const auto items = document_.children(item, "DataItem");
    const pugi::xml_node source = items.size() == 2 ? document_.resolve(items[1]) : pugi::xml_node();
    if (!source) return failed(item, "a HyperSlab needs two DataItems");
    const auto numbers = read_places(items[0], level);
    if (!numbers) return numbers.error();
    if (numbers->empty() || numbers->size() % 3 != 0)
        return failed(item, "a HyperSlab without start, stride and count for each dimension");
    const auto third = static_cast<std::ptrdiff_t>(numbers->size() / 3);
    const auto begin = numbers->begin();
    const Box box{{begin, begin + third}, {begin + third, begin + 2 * third}, {begin + 2 * third, numbers->end()}};
    if (is_heavy(source) && text_of(source).find('|') == std::string::npos) {
        auto part = read_heavy(
            document_.file_of(source), text_of(source), [&](std::string_view name) { return file_named(source, name); },
            box, depth);
        if (part || !stated_dimensions(source)) return part;
    } // or the dimensions that are stated are not those of the data set
    auto whole = read_nested(source, depth, level);
    if (!whole) return whole;
    if (!lies_in(box, whole->dimensions)) return failed(item, "a HyperSlab does not lie within what it is taken from");
    ShapedValues part{box.count, whole->values};
    if (depth == Depth::arrays) part.values = values_at(whole->values, places_of(box, whole->dimensions));
    return part;
}

/// Two DataItems: a place in each dimension for each value; and what they are taken from.
Result<ShapedValues> XdmfData::read_coordinates(pugi::xml_node item, Depth depth, int level) const {
    const auto items = document_.children(item, "DataItem");
    if (items.size() != 2) return failed(item, "Coordinates need two DataItems");
    const auto numbers = read_places(items[0], level);
    if (!numbers) return numbers.error();
    auto whole = read_nested(items[1], depth, level);
    if (!whole) return whole;
    const std::size_t rank = whole->dimensions.size();
    if (rank == 0 || numbers->size() % rank != 0)
        return failed(item,
                      fmt::format("Coordinates of {} numbers are no places in {} dimensions", numbers->size(), rank));
    std::vector<std::uint64_t> places(numbers->size() / rank, 0);
    for (std::size_t i = 0; i < numbers->size(); ++i) {
        if ((*numbers)[i] >= whole->dimensions[i % rank])
            return failed(item, fmt::format("Coordinates have place {} in a dimension of {}", (*numbers)[i],
                                            whole->dimensions[i % rank]));
        places[i / rank] = places[i / rank] * whole->dimensions[i % rank] + (*numbers)[i];
    }
    ShapedValues part{{places.size()}, whole->values};
    if (depth == Depth::arrays) part.values = values_at(whole->values, places);
    return part;
}

Result<ShapedValues> XdmfData::read_function(pugi::xml_node item, Depth depth, int level) const {
    const auto dimensions = stated_dimensions(item);
    ShapedValues result{dimensions.value_or(std::vector<std::uint64_t>()),
                        Array(ScalarType::float64, nullptr, 0, 1, nullptr)};
    if (dimensions && depth == Depth::description) return result;
    std::vector<Array> items;
    for (const pugi::xml_node argument : document_.children(item, "DataItem")) {
        auto values = read_nested(argument, Depth::arrays, level);
        if (!values) return values;
        items.push_back(std::move(values->values));
    }
    auto values = evaluate_function(item.attribute("Function").as_string(), items);
    if (!values) return failed(item, values.error().message);
    if (dimensions && result.count() != values->size())
        return failed(item, fmt::format("a Function has {} values, but {} are stated", values->size(), result.count()));
    if (!dimensions) result.dimensions = {values->size()};
    if (depth == Depth::arrays) result.values = Array::own(*std::move(values));
    return result;
}

} // namespace isotet::io::confined
