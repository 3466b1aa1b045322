// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Legacy VTK polydata (.vtk), ascii and binary, versions 1.0 to 5.1.
#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>

#include <fmt/core.h>

#include "core/errors.hpp"
#include "io/own/pace.hpp"
#include "io/own/surface_parts.hpp"
#include "io/own/surface_scalars.hpp"

namespace isotet::io {
namespace {

constexpr std::uint64_t most_components = 1U << 20U;
constexpr int first_version_with_offsets = 5;

struct TypeName {
    std::string_view name;
    ScalarType type;
};
// vtkIdType is written as int, whatever its size in memory; long has the 8 bytes that it has on 64-bit Unix.
constexpr std::array type_names{TypeName{"char", ScalarType::int8},
                                TypeName{"signed_char", ScalarType::int8},
                                TypeName{"unsigned_char", ScalarType::uint8},
                                TypeName{"short", ScalarType::int16},
                                TypeName{"unsigned_short", ScalarType::uint16},
                                TypeName{"int", ScalarType::int32},
                                TypeName{"vtkidtype", ScalarType::int32},
                                TypeName{"unsigned_int", ScalarType::uint32},
                                TypeName{"long", ScalarType::int64},
                                TypeName{"vtktypeint64", ScalarType::int64},
                                TypeName{"unsigned_long", ScalarType::uint64},
                                TypeName{"vtktypeuint64", ScalarType::uint64},
                                TypeName{"float", ScalarType::float32},
                                TypeName{"double", ScalarType::float64}};

std::string lower(std::string_view word) {
    std::string result(word);
    for (char& c : result) {
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    }
    return result;
}

/// %20 and so on, as VTK's writer makes them, back to bytes.
std::string decoded_name(std::string_view word) {
    std::string result;
    for (std::size_t i = 0; i < word.size(); ++i) {
        unsigned char byte = 0;
        const auto digits = word.substr(i + 1, 2);
        if (word[i] == '%' && digits.size() == 2 &&
            std::from_chars(digits.data(), digits.data() + 2, byte, 16).ptr == digits.data() + 2) {
            result += static_cast<char>(byte);
            i += 2;
        } else {
            result += word[i];
        }
    }
    return result;
}

class LegacyReader {
public:
    LegacyReader(std::string_view content, const Progress& progress)
        : content_(content), scanner_(content), progress_(progress) {}

    Result<Surface> read() {
        if (auto header = read_header(); !header) return header.error();
        for (;;) {
            if (progress_.cancelled()) return Pace::cancelled();
            progress_("read", static_cast<double>(scanner_.position()) / static_cast<double>(content_.size()));
            const auto keyword = lower(scanner_.word());
            if (keyword.empty()) break;
            if (auto section = read_section(keyword); !section) return section.error();
        }
        if (!has_points_) return invalid_data("the file has no POINTS");
        return finish();
    }

private:
    enum class Data : std::uint8_t { none, points, cells };

    Result<void> read_header() {
        constexpr std::string_view start = "# vtk DataFile Version ";
        if (!content_.starts_with(start))
            return invalid_data("the file does not start with \"# vtk DataFile Version\"");
        scanner_.seek(start.size());
        const auto version = scanner_.word_of_line();
        if (!parse_number(version.substr(0, version.find('.')), version_))
            return invalid_data(fmt::format("the version {} is not a number", in_quotes(version)));
        scanner_.next_line(); // the rest of the version
        scanner_.next_line(); // the title
        const auto form = lower(scanner_.word());
        if (form != "ascii" && form != "binary")
            return invalid_data(fmt::format("the third line is {}, not ASCII or BINARY", in_quotes(form)));
        binary_ = form == "binary";
        return {};
    }

    Result<void> read_section(std::string_view keyword) {
        if (keyword == "dataset") return read_dataset();
        if (keyword == "points") return read_points();
        if (keyword == "vertices") return read_cells(vertices_, keyword);
        if (keyword == "lines") return read_cells(lines_, keyword);
        if (keyword == "polygons") return read_cells(polygons_, keyword);
        if (keyword == "triangle_strips") return read_cells(strips_, keyword);
        if (keyword == "metadata") return skip_metadata();
        if (keyword == "cell_data") return start_data(Data::cells);
        if (keyword == "point_data") return start_data(Data::points);
        return read_attribute(keyword);
    }

    Result<void> read_dataset() {
        const auto kind = lower(scanner_.word());
        if (kind != "polydata")
            return invalid_data(fmt::format("this is a dataset of kind {}, not a surface (POLYDATA)", in_quotes(kind)));
        is_polydata_ = true;
        return {};
    }

    Result<std::uint64_t> read_count(std::string_view what) {
        std::uint64_t count = 0;
        if (!scanner_.number(count)) return invalid_data(fmt::format("{}: {} is not a count", scanner_.where(), what));
        return count;
    }

    Result<ScalarType> read_type() {
        const auto name = lower(scanner_.word());
        const auto* known = std::ranges::find(type_names, name, &TypeName::name);
        if (known == type_names.end())
            return invalid_data(
                fmt::format("before {}: {} is not a type that is read", scanner_.where(), in_quotes(name)));
        return known->type;
    }

    /// Scalars from the next line on, in binary files big endian.
    Result<Array> read_scalars(ScalarType type, std::uint64_t tuples, std::uint64_t components, std::string_view what) {
        if (components == 0 || components > most_components)
            return invalid_data(fmt::format("{} has {} components, not 1 to {}", what, components, most_components));
        if (!binary_) return scan_scalars(scanner_, type, tuples, components, what, progress_);
        scanner_.next_line();
        const auto bytes = bytes_needed(type, tuples, components, scanner_.left());
        if (!bytes) {
            return invalid_data(fmt::format("{}: {} x {} {} were announced, but only {} bytes are left", what, tuples,
                                            components, name_of(type), scanner_.left()));
        }
        auto array = decode_scalars(type, scanner_.rest().substr(0, *bytes), static_cast<std::size_t>(components),
                                    std::endian::big);
        scanner_.seek(scanner_.position() + *bytes);
        return array;
    }

    Result<void> read_points() {
        if (!is_polydata_) return invalid_data("POINTS before DATASET POLYDATA");
        if (has_points_) return invalid_data(fmt::format("{}: POINTS occurs twice", scanner_.where()));
        const auto count = read_count("the number of points");
        if (!count) return count.error();
        const auto type = read_type();
        if (!type) return type.error();
        auto positions = read_scalars(*type, *count, 3, "POINTS");
        if (!positions) return positions.error();
        if (!is_floating(positions->type())) {
            positions = positions->visit(
                [](auto values) { return Array::own(std::vector<double>(values.begin(), values.end()), 3); });
        }
        parts_.positions = std::move(*positions);
        has_points_ = true;
        return {};
    }

    /// Corners of cells one after another, and where each cell ends.
    struct CellList {
        std::vector<std::uint64_t> corners, ends;
    };

    Result<void> read_cells(CellList& cells, std::string_view keyword) {
        if (!is_polydata_) return invalid_data(fmt::format("{} before DATASET POLYDATA", keyword));
        if (!cells.ends.empty()) return invalid_data(fmt::format("{}: {} occurs twice", scanner_.where(), keyword));
        const auto first = read_count("the number of cells"), second = read_count("the size of the cells");
        if (!first) return first.error();
        if (!second) return second.error();
        return version_ >= first_version_with_offsets ? read_offsets(cells, keyword, *first, *second)
                                                      : read_interleaved(cells, keyword, *first, *second);
    }

    /// Until version 4.2: count, corner, corner, ..., count, ...
    Result<void> read_interleaved(CellList& cells, std::string_view keyword, std::uint64_t count, std::uint64_t size) {
        const auto values = read_scalars(ScalarType::int32, size, 1, keyword);
        if (!values) return values.error();
        const auto numbers = as_indices(*values);
        std::size_t at = 0;
        for (std::uint64_t i = 0; i < count; ++i) {
            if (at >= numbers.size() || numbers[at] > numbers.size() - at - 1) {
                return invalid_data(
                    fmt::format("{}: cell {} of {} does not fit into the {} numbers", keyword, i, count, size));
            }
            const auto corners = std::span(numbers).subspan(at + 1, static_cast<std::size_t>(numbers[at]));
            cells.corners.insert(cells.corners.end(), corners.begin(), corners.end());
            cells.ends.push_back(cells.corners.size());
            at += 1 + corners.size();
        }
        return {};
    }

    /// From version 5.1 on: all offsets, one more than there are cells, then all corners.
    Result<void> read_offsets(CellList& cells, std::string_view keyword, std::uint64_t count, std::uint64_t size) {
        std::array<std::vector<std::uint64_t>, 2> numbers;
        const std::array<std::string_view, 2> names{"offsets", "connectivity"};
        const std::array<std::uint64_t, 2> counts{count, size};
        for (std::size_t i = 0; i < 2; ++i) {
            if (count == 0) return {};
            if (const auto word = lower(scanner_.word()); word != names[i]) {
                return invalid_data(fmt::format("{}: {} where {} was expected", keyword, in_quotes(word), names[i]));
            }
            const auto type = read_type();
            if (!type) return type.error();
            if (is_floating(*type))
                return invalid_data(fmt::format("{}: {} of type {}", keyword, names[i], name_of(*type)));
            const auto values = read_scalars(*type, counts[i], 1, keyword);
            if (!values) return values.error();
            numbers[i] = as_indices(*values);
        }
        const auto& offsets = numbers[0];
        for (std::size_t i = 0; i < offsets.size(); ++i) {
            if (offsets[i] > size || offsets[i] < (i == 0 ? 0 : offsets[i - 1])) {
                return invalid_data(fmt::format("{}: offsets[{}] is {}, outside 0 to {} or lower than before", keyword,
                                                i, static_cast<std::int64_t>(offsets[i]), size));
            }
        }
        if (offsets.front() != 0)
            return invalid_data(fmt::format("{}: the first offset is {}, not 0", keyword, offsets.front()));
        cells.corners = std::move(numbers[1]);
        cells.ends.assign(offsets.begin() + 1, offsets.end());
        return {};
    }

    /// Lines up to an empty one.
    Result<void> skip_metadata() {
        scanner_.next_line();
        while (scanner_.left() > 0 && !scanner_.at_line_end()) scanner_.next_line();
        return {};
    }

    Result<void> start_data(Data data) {
        const auto count = read_count("the number of tuples");
        if (!count) return count.error();
        data_ = data;
        tuples_ = *count;
        return {};
    }

    Result<void> read_attribute(std::string_view keyword) {
        if (keyword == "field") return read_field();
        if (data_ == Data::none)
            return invalid_data(
                fmt::format("before {}: {} is not a section of polydata", scanner_.where(), in_quotes(keyword)));
        if (keyword == "scalars") return read_scalar_attribute();
        if (keyword == "lookup_table") return read_lookup_table();
        if (keyword == "color_scalars") return read_color_scalars();
        if (keyword == "vectors" || keyword == "normals") return read_named(3, keyword == "normals");
        if (keyword == "tensors") return read_named(9, false);
        if (keyword == "tensors6") return read_named(6, false);
        if (keyword == "global_ids" || keyword == "pedigree_ids" || keyword == "edge_flags")
            return read_named(1, false);
        if (keyword == "texture_coordinates") return read_texture_coordinates();
        return invalid_data(
            fmt::format("before {}: {} is not an attribute that is read", scanner_.where(), in_quotes(keyword)));
    }

    void add(std::string_view name, Array values, bool normals) {
        auto& list = data_ == Data::points ? parts_.point_data : parts_.cell_data;
        list.push_back({decoded_name(name), std::move(values), normals});
    }

    Result<void> read_named(std::uint64_t components, bool normals) {
        const std::string name(scanner_.word());
        const auto type = read_type();
        if (!type) return type.error();
        auto values = read_scalars(*type, tuples_, components, in_quotes(name));
        if (!values) return values.error();
        add(name, std::move(*values), normals);
        return {};
    }

    Result<void> read_scalar_attribute() {
        const std::string name(scanner_.word());
        const auto type = read_type();
        if (!type) return type.error();
        std::uint64_t components = 1;
        if (!scanner_.at_line_end() && !scanner_.number_of_line(components))
            return invalid_data(fmt::format("{}: not a number of components", scanner_.where()));
        const auto before = scanner_.position();
        if (lower(scanner_.word()) == "lookup_table") scanner_.word_of_line(); // its name; it is optional
        else scanner_.seek(before);
        auto values = read_scalars(*type, tuples_, components, in_quotes(name));
        if (!values) return values.error();
        add(name, std::move(*values), false);
        return {};
    }

    /// Colours for drawing: read over. Bytes in binary files, floats in ascii ones.
    Result<void> read_lookup_table() {
        scanner_.word();
        const auto count = read_count("the size of the table");
        if (!count) return count.error();
        const auto values = read_scalars(binary_ ? ScalarType::uint8 : ScalarType::float32, *count, 4, "LOOKUP_TABLE");
        if (!values) return values.error();
        return {};
    }

    Result<void> read_color_scalars() {
        const std::string name(scanner_.word());
        const auto components = read_count("the number of components");
        if (!components) return components.error();
        auto values =
            read_scalars(binary_ ? ScalarType::uint8 : ScalarType::float32, tuples_, *components, in_quotes(name));
        if (!values) return values.error();
        add(name, std::move(*values), false);
        return {};
    }

    Result<void> read_texture_coordinates() {
        const std::string name(scanner_.word());
        const auto dimension = read_count("the dimension");
        if (!dimension) return dimension.error();
        const auto type = read_type();
        if (!type) return type.error();
        auto values = read_scalars(*type, tuples_, *dimension, in_quotes(name));
        if (!values) return values.error();
        add(name, std::move(*values), false);
        return {};
    }

    /// FIELD name count, then for each array: name components tuples type. Outside of point and cell data it belongs to
    /// the whole file and is read over.
    Result<void> read_field() {
        scanner_.word();
        const auto count = read_count("the number of arrays");
        if (!count) return count.error();
        for (std::uint64_t i = 0; i < *count; ++i) {
            std::string name(scanner_.word());
            if (lower(name) == "metadata") {
                if (auto skipped = skip_metadata(); !skipped) return skipped;
                name = scanner_.word();
            }
            if (name.empty()) return invalid_data(fmt::format("the file ends before array {} of {}", i, *count));
            if (name == "NULL_ARRAY") continue;
            const auto components = read_count("the number of components"), tuples = read_count("the number of tuples");
            if (!components) return components.error();
            if (!tuples) return tuples.error();
            const bool is_text = lower(peek_word()) == "string";
            if (is_text) {
                if (auto skipped = skip_strings(*components, *tuples); !skipped) return skipped;
                continue;
            }
            const auto type = read_type();
            if (!type) return type.error();
            auto values = read_scalars(*type, *tuples, *components, in_quotes(name));
            if (!values) return values.error();
            if (data_ != Data::none) add(name, std::move(*values), false);
        }
        return {};
    }

    std::string_view peek_word() {
        const auto before = scanner_.position();
        const auto word = scanner_.word();
        scanner_.seek(before);
        return word;
    }

    /// Strings: in ascii files a line each; in binary ones a length of 6, 14, 30 or 62 bits, then the characters.
    Result<void> skip_strings(std::uint64_t components, std::uint64_t tuples) {
        scanner_.word();
        scanner_.next_line();
        if (components == 0 || tuples > scanner_.left() / components)
            return invalid_data(fmt::format("{} x {} strings do not fit into the file", tuples, components));
        for (std::uint64_t i = 0; i < tuples * components; ++i) {
            if (scanner_.left() == 0) return invalid_data("the file ends inside an array of strings");
            if (!binary_) {
                scanner_.next_line();
                continue;
            }
            const auto rest = scanner_.rest();
            const auto first = static_cast<unsigned char>(rest[0]);
            const std::size_t length_bytes = std::size_t{1} << (3U - (first >> 6U));
            std::uint64_t length = first & 0x3FU;
            if (rest.size() < length_bytes) return invalid_data("the file ends inside an array of strings");
            for (std::size_t k = 1; k < length_bytes; ++k)
                length = (length << 8U) | static_cast<unsigned char>(rest[k]);
            if (length > rest.size() - length_bytes) return invalid_data("the file ends inside an array of strings");
            scanner_.seek(scanner_.position() + length_bytes + static_cast<std::size_t>(length));
        }
        return {};
    }

    Result<Surface> finish() {
        parts_.cells.skip_cells(vertices_.ends.size() + lines_.ends.size());
        for (const auto* list : {&polygons_, &strips_}) {
            std::uint64_t begin = 0;
            for (const auto end : list->ends) {
                const auto corners = std::span(list->corners).subspan(begin, end - begin);
                if (list == &polygons_) parts_.cells.add_polygon(corners);
                else parts_.cells.add_strip(corners);
                begin = end;
            }
        }
        return assemble(std::move(parts_));
    }

    std::string_view content_;
    TextScanner scanner_;
    const Progress& progress_;
    int version_ = 0;
    bool binary_ = false, is_polydata_ = false, has_points_ = false;
    CellList vertices_, lines_, polygons_, strips_;
    Data data_ = Data::none;
    std::uint64_t tuples_ = 0;
    SurfaceParts parts_;
};

} // namespace

Result<Surface> parse_legacy_vtk(std::string_view content, const Progress& progress) {
    return LegacyReader(content, progress).read();
}

} // namespace isotet::io
