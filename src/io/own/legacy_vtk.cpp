// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/own/legacy_vtk.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/core.h>

#include "core/errors.hpp"
#include "io/own/legacy_cells.hpp"
#include "io/own/legacy_values.hpp"
#include "io/own/loaded.hpp"
#include "io/own/pace.hpp"
#include "io/own/text_scanner.hpp"

namespace isotet::io {
namespace {

/// %20 and so on, as VTK's writer makes them, back to bytes; of a broken one VTK takes the first digit.
std::string decoded_name(std::string_view word) {
    std::string result;
    for (std::size_t i = 0; i < word.size(); ++i) {
        unsigned char byte = 0;
        const auto digits = word.substr(i + 1, 2);
        if (word[i] == '%' && digits.size() == 2 &&
            std::from_chars(digits.data(), digits.data() + 2, byte, 16).ec == std::errc()) {
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
    LegacyReader(const ByteSource& source, const LegacyWants& wants, const Progress& progress)
        : source_(source), values_(source, progress), scanner_(values_.scanner()), wants_(wants), progress_(progress) {}

    Result<LegacyFile> read() {
        auto done = read_sections();
        if (scanner_.error()) return *scanner_.error();
        if (!done) return done.error();
        return std::move(file_);
    }

private:
    enum class Data : std::uint8_t { none, points, cells };

    Result<void> read_sections() {
        if (auto header = read_header(); !header) return header;
        for (;;) {
            if (progress_.cancelled()) return Pace::cancelled();
            progress_("read", static_cast<double>(scanner_.position()) / static_cast<double>(source_.size()));
            const auto keyword = lower(scanner_.word());
            if (keyword.empty()) return {};
            if (auto section = read_section(keyword); !section) return section;
        }
    }

    Result<void> read_header() {
        constexpr std::string_view start = "# vtk DataFile Version";
        Scratch scratch;
        const auto first = source_.view(0, std::min(source_.size(), start.size()), scratch);
        if (!first) return first.error();
        if (*first != start) return invalid_data("the file does not start with \"# vtk DataFile Version\"");
        scanner_.next_line(); // the version: CELLS and POLYGONS tell themselves which form they have
        scanner_.next_line(); // the title
        const auto form = lower(scanner_.word());
        if (form != "ascii" && form != "binary")
            return invalid_data(fmt::format("the third line is {}, not ASCII or BINARY", in_quotes(form)));
        values_.set_binary(form == "binary");
        return {};
    }

    Result<void> read_section(const std::string& keyword) {
        if (keyword == "dataset") return read_dataset();
        if (keyword == "field") return read_field();
        if (keyword == "metadata") return skip_metadata();
        if (file_.dataset.empty()) return invalid_data(fmt::format("{} before DATASET", in_quotes(keyword)));
        if (keyword == "points") return read_points();
        if (keyword == "vertices") return read_legacy_cells(values_, keyword, list(), file_.vertices);
        if (keyword == "lines") return read_legacy_cells(values_, keyword, list(), file_.lines);
        if (keyword == "polygons") return read_legacy_cells(values_, keyword, list(), file_.polygons);
        if (keyword == "triangle_strips") return read_legacy_cells(values_, keyword, list(), file_.strips);
        if (keyword == "cells")
            return read_legacy_cells(values_, keyword,
                                     wants_.geometry && wants_.leave_corners ? LegacyList::without_corners : list(),
                                     file_.cells);
        if (keyword == "cell_types") return read_legacy_cell_types(values_, wants_.geometry, file_);
        if (keyword == "dimensions") return read_dimensions();
        if (keyword == "origin") return read_three(file_.origin, keyword);
        if (keyword == "spacing" || keyword == "aspect_ratio") return read_three(file_.spacing, keyword);
        for (std::size_t axis = 0; axis < 3; ++axis)
            if (keyword == std::string(1, "xyz"[axis]) + "_coordinates") return read_coordinates(axis, keyword);
        if (keyword == "cell_data") return start_data(Data::cells);
        if (keyword == "point_data") return start_data(Data::points);
        return read_attribute(keyword);
    }

    LegacyList list() const { return wants_.geometry ? LegacyList::whole : LegacyList::skipped; }

    Result<void> read_dataset() {
        const auto kind = lower(scanner_.word());
        if (!wants_.dataset(kind)) return invalid_data(fmt::format("this is a dataset of kind {}", in_quotes(kind)));
        file_.dataset = kind;
        return {};
    }

    Result<void> read_points() {
        if (file_.has_points) return values_.before_here("POINTS occurs twice");
        const auto count = values_.read_count("the number of points");
        if (!count) return count.error();
        const auto type = values_.read_type();
        if (!type) return type.error();
        auto points = values_.read_floating(*type, *count, 3, "POINTS", wants_.geometry);
        if (!points) return points.error();
        file_.points = std::move(*points);
        file_.has_points = true;
        return {};
    }

    Result<void> read_dimensions() {
        for (std::uint64_t& count : file_.dimensions)
            if (!scanner_.number(count) || count > std::numeric_limits<std::int32_t>::max())
                return values_.before_here("DIMENSIONS are not three counts");
        return {};
    }

    Result<void> read_three(std::array<double, 3>& numbers, std::string_view keyword) {
        for (double& number : numbers)
            if (!scanner_.number(number)) return values_.before_here(fmt::format("{} is not three numbers", keyword));
        return {};
    }

    Result<void> read_coordinates(std::size_t axis, std::string_view keyword) {
        const auto count = values_.read_count("the number of coordinates");
        if (!count) return count.error();
        const auto type = values_.read_type();
        if (!type) return type.error();
        auto values = values_.read_floating(*type, *count, 1, keyword, wants_.geometry);
        if (!values) return values.error();
        file_.coordinates[axis] = std::move(*values);
        return {};
    }

    /// Lines up to an empty one.
    Result<void> skip_metadata() {
        scanner_.next_line();
        while (scanner_.left() > 0 && !scanner_.at_line_end()) scanner_.next_line();
        return {};
    }

    Result<void> start_data(Data data) {
        const auto count = values_.read_count("the number of tuples");
        if (!count) return count.error();
        data_ = data;
        tuples_ = *count;
        return {};
    }

    Result<void> read_attribute(const std::string& keyword) {
        if (data_ == Data::none)
            return values_.before_here(fmt::format("{} is not a section of {}", in_quotes(keyword), file_.dataset));
        if (keyword == "scalars") return read_scalar_attribute();
        if (keyword == "lookup_table") return read_lookup_table();
        if (keyword == "color_scalars") return read_color_scalars();
        if (keyword == "vectors" || keyword == "normals") return read_named(3, keyword == "normals");
        if (keyword == "tensors") return read_named(9, false);
        if (keyword == "tensors6") return read_named(6, false);
        if (keyword == "global_ids" || keyword == "pedigree_ids" || keyword == "edge_flags")
            return read_named(1, false);
        if (keyword == "texture_coordinates") return read_texture_coordinates();
        return values_.before_here(fmt::format("{} is not an attribute that is read", in_quotes(keyword)));
    }

    /// Values of an array with a name, which is announced, and kept if it is wanted.
    /// Of two of one name the last counts.
    Result<void> read_array(const std::string& word, const LegacyType& type, std::uint64_t tuples,
                            std::uint64_t components, bool normals = false) {
        const Association association = data_ == Data::points ? Association::point : Association::cell;
        const std::string name = decoded_name(word);
        const bool is_wanted = data_ != Data::none && wants_.field(association, name);
        auto values = values_.read_values(type, tuples, components, in_quotes(word), is_wanted);
        if (!values) return values.error();
        if (data_ == Data::none) return {};
        announce(file_.info, {name, association, type.widened ? ScalarType::int64 : type.type,
                              static_cast<std::size_t>(components)});
        if (!is_wanted) return {};
        auto& list = association == Association::point ? file_.point_data : file_.cell_data;
        const auto same = std::ranges::find(list, name, &Attribute::name);
        if (same == list.end()) list.push_back({name, std::move(*values), normals});
        else *same = {name, std::move(*values), normals};
        return {};
    }

    Result<void> read_named(std::uint64_t components, bool normals) {
        const std::string name = scanner_.word();
        const auto type = values_.read_type();
        if (!type) return type.error();
        return read_array(name, *type, tuples_, components, normals);
    }

    Result<void> read_scalar_attribute() {
        const std::string name = scanner_.word();
        const auto type = values_.read_type();
        if (!type) return type.error();
        std::uint64_t components = 1;
        if (!scanner_.at_line_end() && !scanner_.number_of_line(components))
            return values_.before_here("not a number of components");
        const auto before = scanner_.position();
        if (lower(scanner_.word()) == "lookup_table") scanner_.word_of_line(); // its name; it is optional
        else scanner_.seek(before);
        return read_array(name, *type, tuples_, components);
    }

    /// Colours for drawing: stepped over. Bytes in binary files, floats in ascii ones.
    Result<void> read_lookup_table() {
        scanner_.word();
        const auto count = values_.read_count("the size of the table");
        if (!count) return count.error();
        const auto values =
            values_.read_values(values_.binary() ? legacy_bytes : legacy_floats, *count, 4, "LOOKUP_TABLE", false);
        if (!values) return values.error();
        return {};
    }

    /// Bytes in binary files, in ascii ones floats from 0 to 1, which become bytes as in VTK.
    Result<void> read_color_scalars() {
        const std::string name = scanner_.word();
        const auto components = values_.read_count("the number of components");
        if (!components) return components.error();
        if (auto read = read_array(name, values_.binary() ? legacy_bytes : legacy_floats, tuples_, *components);
            !read || values_.binary())
            return read;
        for (auto* const list : {&file_.point_data, &file_.cell_data})
            for (Attribute& attribute : *list)
                if (attribute.name == decoded_name(name) && attribute.values.type() == ScalarType::float32)
                    attribute.values = mapped<std::uint8_t>(attribute.values, [](auto value) {
                        const auto scaled = 255.0 * static_cast<double>(value);
                        return static_cast<std::uint8_t>(scaled > 0 ? std::min(scaled, 255.0) : 0.0);
                    });
        for (FieldInfo& field : file_.info.fields)
            if (field.name == decoded_name(name)) field.type = ScalarType::uint8;
        return {};
    }

    Result<void> read_texture_coordinates() {
        const std::string name = scanner_.word();
        const auto dimension = values_.read_count("the dimension");
        if (!dimension) return dimension.error();
        const auto type = values_.read_type();
        if (!type) return type.error();
        return read_array(name, *type, tuples_, *dimension);
    }

    /// FIELD name count, then for each array: name components tuples type. Outside of point and cell data it belongs to
    /// the whole file and is stepped over.
    Result<void> read_field() {
        scanner_.word();
        const auto count = values_.read_count("the number of arrays");
        if (!count) return count.error();
        for (std::uint64_t i = 0; i < *count; ++i) {
            std::string name = scanner_.word();
            while (lower(name) == "metadata") {
                if (auto skipped = skip_metadata(); !skipped) return skipped;
                name = scanner_.word();
            }
            if (name.empty()) return invalid_data(fmt::format("the file ends before array {} of {}", i, *count));
            if (name == "NULL_ARRAY") continue;
            const auto components = values_.read_count("the number of components"),
                       tuples = values_.read_count("the number of tuples");
            if (!components) return components.error();
            if (!tuples) return tuples.error();
            const auto before = scanner_.position();
            const auto type_name = lower(scanner_.word());
            if (type_name == "string" || type_name == "utf8_string") {
                if (auto skipped = skip_strings(*components, *tuples); !skipped) return skipped;
                continue;
            }
            scanner_.seek(before);
            const auto type = values_.read_type();
            if (!type) return type.error();
            if (auto read = read_array(name, *type, *tuples, *components); !read) return read;
        }
        return {};
    }

    /// Strings: in ascii files a line each; in binary ones a length of 6, 14, 30 or 62 bits, then the characters.
    Result<void> skip_strings(std::uint64_t components, std::uint64_t tuples) {
        scanner_.next_line();
        if (components == 0 || tuples > scanner_.left() / components)
            return invalid_data(fmt::format("{} x {} strings do not fit into the file", tuples, components));
        const auto too_short = [] { return invalid_data("the file ends inside an array of strings"); };
        for (std::uint64_t i = 0; i < tuples * components; ++i) {
            if (scanner_.left() == 0) return too_short();
            if (!values_.binary()) {
                scanner_.next_line();
                continue;
            }
            std::array<std::byte, 8> head{};
            const std::size_t at = scanner_.position();
            if (auto read = source_.read(at, std::span(head).first(std::min<std::size_t>(8, scanner_.left()))); !read)
                return read;
            const auto first = std::to_integer<unsigned>(head[0]);
            const std::size_t length_bytes = std::size_t{1} << (3U - (first >> 6U));
            std::uint64_t length = first & 0x3FU;
            if (scanner_.left() < length_bytes) return too_short();
            for (std::size_t k = 1; k < length_bytes; ++k) length = (length << 8U) | std::to_integer<unsigned>(head[k]);
            if (length > scanner_.left() - length_bytes) return too_short();
            scanner_.seek(at + length_bytes + static_cast<std::size_t>(length));
        }
        return {};
    }

    const ByteSource& source_;
    LegacyValues values_;
    SourceScanner& scanner_;
    const LegacyWants& wants_;
    const Progress& progress_;
    Data data_ = Data::none;
    std::uint64_t tuples_ = 0;
    LegacyFile file_;
};

} // namespace

Result<LegacyFile> read_legacy_vtk(const ByteSource& source, const LegacyWants& wants, const Progress& progress) {
    return LegacyReader(source, wants, progress).read();
}

} // namespace isotet::io
