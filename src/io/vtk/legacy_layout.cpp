// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include <fmt/core.h>

#include "io/own/text_scanner.hpp"
#include "io/own/escape.hpp"
#include "io/vtk/legacy_layout.hpp"
#include "io/vtk/mapped_file.hpp"

namespace isotet::io::vtk {
namespace {

struct TypeName {
    std::string_view name;
    ScalarType type;
};
constexpr TypeName type_names[] = {
    {"float", ScalarType::float32},
    {"double", ScalarType::float64},
    {"int", ScalarType::int32},
    {"unsigned_int", ScalarType::uint32},
    {"long", ScalarType::int64},
    {"unsigned_long", ScalarType::uint64},
    {"vtktypeint64", ScalarType::int64},
    {"vtktypeuint64", ScalarType::uint64},
    {"vtkidtype", ScalarType::int32},
    {"short", ScalarType::int16},
    {"unsigned_short", ScalarType::uint16},
    {"char", ScalarType::int8},
    {"signed_char", ScalarType::int8},
    {"unsigned_char", ScalarType::uint8},
};

std::string lower(std::string_view word) {
    std::string result(word);
    std::transform(result.begin(), result.end(), result.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
    return result;
}

std::optional<ScalarType> type_of(std::string_view word) {
    const std::string name = lower(word);
    for (const TypeName& type : type_names)
        if (type.name == name) return type.type;
    return std::nullopt;
}

/// Names are written with %20 for a space and so on.
std::string decoded(std::string_view name) {
    std::string result;
    for (std::size_t i = 0; i < name.size(); ++i) {
        unsigned value = 0;
        const auto code = name.substr(i, 3);
        if (code.size() == 3 && code[0] == '%' &&
            std::from_chars(code.data() + 1, code.data() + 3, value, 16).ptr == code.data() + 3) {
            result += static_cast<char>(value);
            i += 2;
        } else {
            result += name[i];
        }
    }
    return result;
}

class Walk {
public:
    Walk(const std::string& path, std::string_view text) : path_(path), scanner_(text) {}

    Result<LegacyLayout> run() {
        scanner_.next_line();
        scanner_.next_line(); // the title
        const std::string encoding = lower(scanner_.word());
        if (encoding != "ascii" && encoding != "binary")
            return broken(path_, "the third line of a legacy VTK file is ASCII or BINARY");
        binary_ = encoding == "binary";
        while (!stopped_ && !scanner_.at_end()) section(lower(scanner_.word()));
        if (problem_) return *problem_;
        return std::move(layout_);
    }

private:
    void section(const std::string& keyword) {
        if (keyword == "dataset") layout_.dataset = lower(scanner_.word_of_line());
        else if (keyword == "dimensions" || keyword == "origin" || keyword == "spacing" || keyword == "aspect_ratio")
            numbers_of_line(3);
        else if (keyword == "points") counted_values(keyword, 3);
        else if (keyword.ends_with("_coordinates") && keyword.size() == 13) counted_values(keyword, 1);
        else if (keyword == "cells") cells();
        else if (keyword == "cell_types") values(keyword, number(), 1, "int");
        else if (keyword == "point_data" || keyword == "cell_data") {
            association_ = keyword == "point_data" ? Association::point : Association::cell;
            tuples_ = number();
            in_data_ = true;
        } else if (keyword == "field") field_arrays();
        else if (keyword == "metadata") metadata();
        else if (in_data_) attribute(keyword);
        else stopped_ = true;
    }
    void attribute(const std::string& keyword) {
        const auto name = scanner_.word_of_line();
        if (keyword == "scalars") {
            const auto type = scanner_.word_of_line();
            std::uint64_t components = 1;
            if (!scanner_.at_line_end()) components = number();
            const std::size_t before = scanner_.position();
            if (lower(scanner_.word()) == "lookup_table") scanner_.word_of_line();
            else scanner_.seek(before);
            array(name, tuples_, components, type);
        } else if (keyword == "vectors" || keyword == "normals") array(name, tuples_, 3, scanner_.word_of_line());
        else if (keyword == "tensors") array(name, tuples_, 9, scanner_.word_of_line());
        else if (keyword == "tensors6") array(name, tuples_, 6, scanner_.word_of_line());
        else if (keyword == "global_ids" || keyword == "pedigree_ids" || keyword == "edge_flags")
            array(name, tuples_, 1, scanner_.word_of_line());
        else if (keyword == "texture_coordinates") {
            const std::uint64_t components = number();
            array(name, tuples_, components, scanner_.word_of_line());
        } else if (keyword == "color_scalars") array(name, tuples_, number(), "unsigned_char");
        else if (keyword == "lookup_table") values("lookup table", number(), 4, "unsigned_char");
        else stopped_ = true;
    }
    void field_arrays() {
        scanner_.word_of_line();
        const std::uint64_t count = number();
        for (std::uint64_t i = 0; i < count && !stopped_; ++i) {
            while (true) { // "METADATA" may follow each array
                const std::size_t before = scanner_.position();
                if (lower(scanner_.word()) != "metadata") {
                    scanner_.seek(before);
                    break;
                }
                metadata();
            }
            const auto name = scanner_.word();
            if (name.empty()) return fail(fmt::format("a FIELD of {} arrays ends after {}", count, i));
            const std::uint64_t components = number();
            const std::uint64_t tuples = number();
            const auto type = scanner_.word_of_line();
            if (in_data_) array(name, tuples, components, type);
            else values(name, tuples, components, type);
        }
    }
    /// Version 5: "CELLS offsets size", then both arrays with types; before that n and all numbers in one list.
    void cells() {
        const std::uint64_t first = number();
        const std::uint64_t size = number();
        const std::size_t before = scanner_.position();
        if (lower(scanner_.word()) == "offsets") {
            values("offsets", first, 1, scanner_.word_of_line());
            if (!stopped_ && lower(scanner_.word()) != "connectivity") return fail("CELLS without CONNECTIVITY");
            values("connectivity", size, 1, scanner_.word_of_line());
        } else {
            scanner_.seek(before);
            values("cells", size, 1, "int");
        }
    }
    /// Lines up to an empty one.
    void metadata() {
        scanner_.next_line();
        while (scanner_.left() > 0 && !scanner_.at_line_end()) scanner_.next_line();
    }
    void array(std::string_view name, std::uint64_t tuples, std::uint64_t components, std::string_view type_name) {
        const auto type = type_of(type_name);
        if (type && !stopped_ && components > 0)
            announce(layout_.info, {decoded(name), association_, *type, components});
        values(name, tuples, components, type_name);
    }
    /// A count and a type, then values.
    void counted_values(std::string_view what, std::uint64_t components) {
        const std::uint64_t tuples = number();
        values(what, tuples, components, scanner_.word_of_line());
    }
    /// Steps over values.
    void values(std::string_view what, std::uint64_t tuples, std::uint64_t components, std::string_view type_name) {
        if (stopped_) return;
        const auto type = type_of(type_name);
        const bool bits = lower(type_name) == "bit";
        if (!type && !bits) {
            stopped_ = true; // strings and the like: as far as this walk goes
            return;
        }
        constexpr std::uint64_t most = std::uint64_t(1) << 50;
        if (tuples > most || components > 1000)
            return fail(fmt::format("{} has {} x {} values", escaped(what), tuples, components));
        const std::uint64_t count = tuples * components;
        const std::uint64_t size = bits ? (count + 7) / 8 : count * (type ? size_of(*type) : 1);
        if (binary_) {
            scanner_.next_line();
            if (size > scanner_.left()) return too_short(what, size, "bytes", scanner_.left());
            scanner_.seek(scanner_.position() + size);
            return;
        }
        if (count > scanner_.left()) return too_short(what, count, "values", scanner_.left());
        for (std::uint64_t i = 0; i < count; ++i)
            if (scanner_.word().empty()) return too_short(what, count, "values", i);
    }
    std::uint64_t number() {
        std::uint64_t value = 0;
        if (!stopped_ && !scanner_.number_of_line(value)) fail("a count is missing or negative at " + scanner_.where());
        return value;
    }
    void numbers_of_line(int count) {
        double value = 0;
        for (int i = 0; i < count && !stopped_; ++i)
            if (!scanner_.number_of_line(value)) fail("a number is missing at " + scanner_.where());
    }
    void too_short(std::string_view what, std::uint64_t needed, std::string_view unit, std::uint64_t there) {
        fail(fmt::format("{} has {} {}, but the file ends after {}: it is cut short", escaped(what), needed, unit,
                         there));
    }
    void fail(std::string_view what) {
        if (!problem_) problem_ = broken(path_, what);
        stopped_ = true;
    }

    const std::string& path_;
    TextScanner scanner_;
    LegacyLayout layout_;
    std::optional<Error> problem_;
    Association association_ = Association::point;
    std::uint64_t tuples_ = 0;
    bool binary_ = false, in_data_ = false, stopped_ = false;
};

} // namespace

Result<LegacyLayout> legacy_layout(const std::string& path) {
    auto file = MappedFile::open(path);
    if (!file) return file.error();
    return Walk(path, file->text()).run();
}

} // namespace isotet::io::vtk
