// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// PLY: ascii, binary little and big endian; every scalar property of vertices and faces is a field.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <variant>

#include <fmt/core.h>

#include "base/errors.hpp"
#include "io/files/byte_reader.hpp"
#include "io/files/pace.hpp"
#include "io/files/scalars.hpp"
#include "io/surfaces/surface_parts.hpp"

namespace isotet::io {
namespace {

enum class Encoding : std::uint8_t { ascii, little, big };

struct Property {
    std::string name;
    ScalarType type = ScalarType::float32;
    std::optional<ScalarType> count_type; ///< of a list
};

struct Element {
    std::string name;
    std::uint64_t count = 0;
    std::vector<Property> properties;
};

struct Header {
    Encoding encoding = Encoding::ascii;
    std::vector<Element> elements;
    std::size_t end = 0; ///< where the data starts
};

std::optional<ScalarType> type_of(std::string_view name) {
    struct Name {
        std::string_view name;
        ScalarType type;
    };
    constexpr std::array names{
        Name{"char", ScalarType::int8},      Name{"int8", ScalarType::int8},       Name{"uchar", ScalarType::uint8},
        Name{"uint8", ScalarType::uint8},    Name{"short", ScalarType::int16},     Name{"int16", ScalarType::int16},
        Name{"ushort", ScalarType::uint16},  Name{"uint16", ScalarType::uint16},   Name{"int", ScalarType::int32},
        Name{"int32", ScalarType::int32},    Name{"uint", ScalarType::uint32},     Name{"uint32", ScalarType::uint32},
        Name{"float", ScalarType::float32},  Name{"float32", ScalarType::float32}, Name{"double", ScalarType::float64},
        Name{"float64", ScalarType::float64}};
    const auto* found = std::ranges::find(names, name, &Name::name);
    if (found == names.end()) return std::nullopt;
    return found->type;
}

Result<Property> read_property(TextScanner& scanner) {
    Property property;
    auto word = scanner.word_of_line();
    const auto type = [&]() -> std::optional<ScalarType> { return type_of(word); };
    if (word == "list") {
        word = scanner.word_of_line();
        property.count_type = type();
        if (!property.count_type || is_floating(*property.count_type)) {
            return invalid_data(
                fmt::format("{}: a list is counted by integers, not by {}", scanner.where(), in_quotes(word)));
        }
        word = scanner.word_of_line();
    }
    const auto value_type = type();
    if (!value_type) return invalid_data(fmt::format("{}: {} is not a type of PLY", scanner.where(), in_quotes(word)));
    property.type = *value_type;
    property.name = scanner.word_of_line();
    if (property.name.empty()) return invalid_data(fmt::format("{}: a property without a name", scanner.where()));
    return property;
}

Result<Header> read_header(std::string_view content) {
    Header header;
    TextScanner scanner(content);
    bool has_format = false;
    scanner.next_line(); // "ply"
    for (;; scanner.next_line()) {
        if (scanner.left() == 0) return invalid_data("the header has no end_header");
        const auto keyword = scanner.word_of_line();
        if (keyword == "end_header") break;
        if (keyword == "format") {
            const auto name = scanner.word_of_line();
            if (name == "ascii") header.encoding = Encoding::ascii;
            else if (name == "binary_little_endian") header.encoding = Encoding::little;
            else if (name == "binary_big_endian") header.encoding = Encoding::big;
            else return invalid_data(fmt::format("{}: the format {} is not known", scanner.where(), in_quotes(name)));
            has_format = true;
        } else if (keyword == "element") {
            Element element;
            element.name = scanner.word_of_line();
            if (!scanner.number_of_line(element.count))
                return invalid_data(fmt::format("{}: not a count of elements", scanner.where()));
            header.elements.push_back(std::move(element));
        } else if (keyword == "property") {
            if (header.elements.empty())
                return invalid_data(fmt::format("{}: a property of no element", scanner.where()));
            auto property = read_property(scanner);
            if (!property) return property.error();
            header.elements.back().properties.push_back(std::move(*property));
        } else if (!keyword.empty() && keyword != "comment" && keyword != "obj_info") {
            return invalid_data(
                fmt::format("{}: {} does not belong into a header", scanner.where(), in_quotes(keyword)));
        }
    }
    if (!has_format) return invalid_data("the header has no format");
    scanner.next_line();
    header.end = scanner.position();
    return header;
}

/// Scalars of the data, one after another, whatever the encoding.
class ValueReader {
public:
    ValueReader(std::string_view content, std::size_t begin, Encoding encoding)
        : ascii_(encoding == Encoding::ascii),
          text_(content),
          bytes_(content, (encoding == Encoding::big) != (std::endian::native == std::endian::big)) {
        text_.seek(begin);
        bytes_.seek(begin);
    }

    template <class T>
    bool read(T& value) {
        return ascii_ ? read_scalar(text_, value) : bytes_.read(value);
    }

    std::size_t left() const noexcept { return ascii_ ? text_.left() : bytes_.left(); }
    std::size_t position() const noexcept { return ascii_ ? text_.position() : bytes_.position(); }
    /// Bytes that a scalar takes at least.
    std::size_t least(ScalarType type) const noexcept { return ascii_ ? 1 : size_of(type); }
    std::string where() const { return ascii_ ? text_.where() : fmt::format("byte {}", bytes_.position()); }

private:
    bool ascii_;
    TextScanner text_;
    ByteReader bytes_;
};

/// The values of one scalar property.
using Values =
    std::variant<std::vector<std::int8_t>, std::vector<std::uint8_t>, std::vector<std::int16_t>,
                 std::vector<std::uint16_t>, std::vector<std::int32_t>, std::vector<std::uint32_t>,
                 std::vector<std::int64_t>, std::vector<std::uint64_t>, std::vector<float>, std::vector<double>>;

/// Reads the rows of one element: scalars into arrays, the list of corners into cells, other lists into nothing.
class ElementReader {
public:
    ElementReader(const Element& element, ValueReader& reader, const Progress& progress)
        : element_(element), reader_(reader), progress_(progress) {}

    /// `cells`   null: lists are skipped
    Result<std::vector<Attribute>> read(TriangleList* cells) {
        if (auto fits = check_size(); !fits) return fits.error();
        std::vector<Values> columns;
        for (const auto& property : element_.properties) {
            columns.push_back(
                with_type(property.type, [&](auto zero) -> Values { return std::vector<decltype(zero)>(); }));
            const auto reserve = [&](auto& values) { values.reserve(static_cast<std::size_t>(element_.count)); };
            if (!property.count_type) std::visit(reserve, columns.back());
        }
        Pace pace(progress_, reader_.position() + reader_.left());
        for (std::uint64_t row = 0; row < element_.count; ++row) {
            for (std::size_t i = 0; i < columns.size(); ++i) {
                const auto& property = element_.properties[i];
                const bool corners = cells && (property.name == "vertex_indices" || property.name == "vertex_index");
                const bool read =
                    property.count_type ? read_list(property, corners ? cells : nullptr) : read_one(columns[i]);
                if (!read) return failure(row, property);
            }
            if (!pace.goes_on(reader_.position())) return Pace::cancelled();
        }
        std::vector<Attribute> attributes;
        for (std::size_t i = 0; i < columns.size(); ++i) {
            if (element_.properties[i].count_type) continue;
            attributes.push_back({element_.properties[i].name,
                                  std::visit([](auto& values) { return Array::own(std::move(values)); }, columns[i])});
        }
        return attributes;
    }

private:
    Result<void> check_size() const {
        std::size_t row = 0;
        for (const auto& property : element_.properties)
            row += reader_.least(property.count_type.value_or(property.type));
        if (element_.count > 0 && (row == 0 || element_.count > reader_.left() / row)) {
            return invalid_data(
                fmt::format("{} elements \"{}\" of at least {} bytes are announced, but {} bytes are left",
                            element_.count, element_.name, row, reader_.left()));
        }
        return {};
    }

    bool read_one(Values& column) {
        return std::visit(
            [&](auto& values) {
                typename std::remove_reference_t<decltype(values)>::value_type value{};
                if (!reader_.read(value)) return false;
                values.push_back(value);
                return true;
            },
            column);
    }

    /// An integer of any type; nothing if there is none, or it is not whole. Negative ones become huge.
    std::optional<std::uint64_t> read_integer(ScalarType type) {
        return with_type(type, [&](auto value) -> std::optional<std::uint64_t> {
            if (!reader_.read(value)) return std::nullopt;
            if constexpr (std::is_floating_point_v<decltype(value)>) {
                if (!(value >= 0) || value >= 9007199254740992.0 || value != std::floor(value)) return std::nullopt;
            }
            return static_cast<std::uint64_t>(value);
        });
    }

    bool read_list(const Property& property, TriangleList* cells) {
        const auto count = read_integer(*property.count_type);
        if (!count || *count > reader_.left() / reader_.least(property.type)) return false;
        corners_.clear();
        for (std::uint64_t i = 0; i < *count; ++i) {
            if (!cells) {
                if (!with_type(property.type, [&](auto value) { return reader_.read(value); })) return false;
                continue;
            }
            const auto corner = read_integer(property.type);
            if (!corner) return false;
            corners_.push_back(*corner);
        }
        if (cells) cells->add_polygon(corners_);
        return true;
    }

    Error failure(std::uint64_t row, const Property& property) const {
        return invalid_data(fmt::format("{}: the property {} of element {} number {} of {} cannot be read",
                                        reader_.where(), in_quotes(property.name), in_quotes(element_.name), row,
                                        element_.count));
    }

    const Element& element_;
    ValueReader& reader_;
    const Progress& progress_;
    std::vector<std::uint64_t> corners_;
};

/// Takes three properties out of the list and makes one array of them; empty if one is missing.
Array take_vector(std::vector<Attribute>& attributes, const std::array<std::string_view, 3>& names) {
    std::array<Array, 3> parts;
    for (std::size_t i = 0; i < 3; ++i) {
        const auto found = std::ranges::find(attributes, names[i], &Attribute::name);
        if (found == attributes.end()) return {};
        parts[i] = found->values;
    }
    std::erase_if(attributes,
                  [&](const Attribute& attribute) { return std::ranges::find(names, attribute.name) != names.end(); });
    const bool all_float =
        std::ranges::all_of(parts, [](const Array& part) { return part.type() == ScalarType::float32; });
    const auto joined = [&]<class Scalar>(Scalar) {
        std::vector<Scalar> values(3 * parts[0].tuples());
        for (std::size_t k = 0; k < 3; ++k) {
            parts[k].visit([&](auto part) {
                for (std::size_t i = 0; i < part.size(); ++i) values[3 * i + k] = static_cast<Scalar>(part[i]);
            });
        }
        return Array::own(std::move(values), 3);
    };
    return all_float ? joined(float{}) : joined(double{});
}

void take_normals(std::vector<Attribute>& attributes) {
    Array normals = take_vector(attributes, {"nx", "ny", "nz"});
    if (is_floating(normals.type()) && normals.components() == 3)
        attributes.push_back({"Normals", std::move(normals), true});
}

} // namespace

Result<Surface> parse_ply(std::string_view content, const Progress& progress) {
    const auto header = read_header(content);
    if (!header) return header.error();
    ValueReader reader(content, header->end, header->encoding);
    SurfaceParts parts;
    bool has_vertices = false, has_faces = false, has_strips = false;
    for (const auto& element : header->elements) {
        const bool vertices = element.name == "vertex", faces = element.name == "face";
        if ((vertices && has_vertices) || (faces && has_faces))
            return invalid_data(fmt::format("the element {} occurs twice", in_quotes(element.name)));
        auto attributes = ElementReader(element, reader, progress).read(faces ? &parts.cells : nullptr);
        if (!attributes) return attributes.error();
        has_strips = has_strips || element.name == "tristrips";
        if (vertices) {
            has_vertices = true;
            parts.positions = take_vector(*attributes, {"x", "y", "z"});
            if (parts.positions.components() != 3) return invalid_data("the vertices have no properties x, y and z");
            take_normals(*attributes);
            parts.point_data = std::move(*attributes);
        } else if (faces) {
            has_faces = true;
            if (parts.cells.cells() != element.count)
                return invalid_data("the faces have no list vertex_indices, or several");
            take_normals(*attributes);
            parts.cell_data = std::move(*attributes);
        }
    }
    if (!has_vertices) return invalid_data("the file has no element vertex");
    if (!has_faces && has_strips)
        return invalid_data("the file holds triangle strips (tristrips), which are not read from PLY: only faces are");
    return assemble(std::move(parts));
}

} // namespace isotet::io
