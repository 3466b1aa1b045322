// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/vtk_legacy/legacy_data.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <set>
#include <span>
#include <utility>

#include <fmt/core.h>

#include "base/errors.hpp"
#include "io/files/text_scanner.hpp"
#include "io/files/time_values.hpp"
#include "io/pieces/loaded.hpp"
#include "io/pieces/tensor_order.hpp"

namespace isotet::io {
namespace {

constexpr std::array<std::string_view, 14> data_sections{"point_data",
                                                         "cell_data",
                                                         "field",
                                                         "metadata",
                                                         "scalars",
                                                         "vectors",
                                                         "normals",
                                                         "tensors",
                                                         "lookup_table",
                                                         "color_scalars",
                                                         "texture_coordinates",
                                                         "global_ids",
                                                         "pedigree_ids",
                                                         "edge_flags"};
constexpr std::array<std::string_view, 17> other_sections{
    "tensors6", "points",       "cells",   "cell_types",    "vertices",      "lines",
    "polygons", "dimensions",   "extent",  "origin",        "x_coordinates", "y_coordinates",
    "spacing",  "aspect_ratio", "dataset", "z_coordinates", "blanking"};
constexpr std::size_t most_words = 32;  ///< of a line that names an array
constexpr std::size_t max_faults = 100; ///< each may take a search through the rest of the file

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

bool is_count(std::string_view word) {
    std::uint64_t count = 0;
    return parse_number(word, count);
}

/// A word of letters, digits and underscores that no number begins with.
bool is_identifier(std::string_view word) {
    const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; };
    return !word.empty() && is_letter(word.front()) &&
           std::ranges::all_of(word, [&](char c) { return is_letter(c) || (c >= '0' && c <= '9'); });
}

/// A type of values, in lower case. FreeFem 3 writes "int1".
std::string type_in(const std::string& word) {
    std::string type = lower(word);
    if (type.ends_with('1') && !legacy_type(type)) type.pop_back();
    return type;
}

bool is_type(const std::string& word) { return legacy_type(type_in(word)).has_value(); }

/// Of a FIELD: the name, components, tuples and the type. A name of several words must be followed by a type that is known.
bool is_line_of_array(std::span<const std::string> words) {
    const std::size_t count = words.size();
    return count >= 3 && is_count(words[count - 3]) && is_count(words[count - 2]) &&
           (count == 4 ? is_identifier(words[count - 1]) : is_type(words[count - 1]));
}

std::string kind_of(Association association) {
    return association == Association::point ? "point field" : "cell field";
}

Array bytes_of_colors(const Array& colors) {
    return mapped<std::uint8_t>(colors, [](auto value) {
        const auto scaled = 255.0 * static_cast<double>(value);
        return static_cast<std::uint8_t>(scaled > 0 ? std::min(scaled, 255.0) : 0.0);
    });
}

} // namespace

bool LegacyData::is_section(std::string_view keyword) {
    return keyword == "tensors6" || std::ranges::find(data_sections, keyword) != data_sections.end();
}

Result<void> LegacyData::read(const std::string& keyword) {
    if (keyword == "metadata") {
        read_metadata();
        return {};
    }
    if (keyword == "field") return read_field();
    if (file_.dataset.empty()) return invalid_data(fmt::format("{} before DATASET", in_quotes(keyword)));
    if (keyword == "point_data") return start_data(Data::points);
    if (keyword == "cell_data") return start_data(Data::cells);
    const std::size_t start = scanner_.position();
    if (data_ == Data::none)
        return values_.before_here(fmt::format("{} before POINT_DATA and CELL_DATA", in_quotes(keyword)));
    auto done = read_section(keyword);
    if (done || !may_go_on(done.error())) return done;
    scanner_.seek(start);
    leave_out(file_.info, {"section", keyword, done.error().message});
    return go_on_behind(0, done.error());
}

Result<void> LegacyData::read_section(const std::string& keyword) {
    if (keyword == "scalars") return read_scalars();
    if (keyword == "lookup_table") return read_lookup_table();
    if (keyword == "color_scalars") return read_color_scalars();
    if (keyword == "vectors" || keyword == "normals") return read_named(3, keyword == "normals");
    if (keyword == "tensors") return read_named(9, false);
    if (keyword == "tensors6") return read_named(6, false);
    if (keyword == "texture_coordinates") return read_texture_coordinates();
    return read_named(1, false); // GLOBAL_IDS, PEDIGREE_IDS, EDGE_FLAGS
}

Result<void> LegacyData::read_unknown(const std::string& keyword) {
    const std::size_t start = scanner_.position() - keyword.size();
    scanner_.seek(start);
    const Error error = values_.before_here(fmt::format("{} is not a section that is read", in_quotes(keyword)));
    std::array<std::byte, 1> before{};
    if (auto read = values_.source().read(start - 1, before); !read) return read;
    if (is_identifier(keyword) && (!values_.binary() || before[0] == std::byte{'\n'})) {
        leave_out(file_.info, {"section", keyword, "it is not known"});
        return go_on_behind(0, error);
    }
    return data_ == Data::none ? error : lose(keyword, 0, error);
}

Result<void> LegacyData::start_data(Data data) {
    const auto count = values_.read_count("the number of tuples");
    if (!count) return count.error();
    data_ = data;
    tuples_ = *count;
    return {};
}

/// Up to so many words of this line, without moving.
std::vector<std::string> LegacyData::words_of_line(std::size_t most) {
    const std::size_t before = scanner_.position();
    std::vector<std::string> words;
    while (words.size() < most && !scanner_.at_line_end()) words.push_back(scanner_.word_of_line());
    scanner_.seek(before);
    return words;
}

/// The words of this line before the last ones, which are `behind` the name. VTK writes an empty name as nothing, and a blank
/// in a name as %20, but others leave it as it is.
std::string LegacyData::read_name(std::size_t behind) {
    const auto words = words_of_line(most_words);
    if (behind > words.size()) return scanner_.word();
    std::string name;
    for (std::size_t i = 0; i + behind < words.size(); ++i) name += (i > 0 ? " " : "") + scanner_.word();
    return name;
}

/// How many words of this line are behind a name: a type, and of SCALARS perhaps a number of components. Without either the
/// name is one word.
std::size_t LegacyData::words_behind_name() {
    const auto words = words_of_line(most_words);
    const std::size_t count = words.size();
    if (count > 0 && is_type(words[count - 1])) return 1;
    if (count > 1 && is_count(words[count - 1]) && is_type(words[count - 2])) return 2;
    return count > 0 ? count - 1 : 1;
}

Result<void> LegacyData::read_named(std::uint64_t components, bool normals) {
    Header header{read_name(words_behind_name()), {}, components, tuples_, normals};
    header.type = type_in(scanner_.word());
    return read_array(header);
}

Result<void> LegacyData::read_scalars() {
    Header header{read_name(words_behind_name()), {}, 1, tuples_};
    scalars_.emplace_back(data_ == Data::points ? Association::point : Association::cell, decoded_name(header.name));
    header.type = type_in(scanner_.word());
    if (!scanner_.at_line_end() && !scanner_.number_of_line(header.components))
        return values_.before_here("not a number of components");
    const auto before = scanner_.position();
    if (lower(scanner_.word()) == "lookup_table") scanner_.word_of_line(); // its name; it is optional
    else scanner_.seek(before);
    return read_array(header);
}

/// Colours for drawing: stepped over. Bytes in binary files, floats in ascii ones.
Result<void> LegacyData::read_lookup_table() {
    scanner_.word();
    const auto count = values_.read_count("the size of the table");
    if (!count) return count.error();
    const auto values =
        values_.read_values(values_.binary() ? legacy_bytes : legacy_floats, *count, 4, "LOOKUP_TABLE", false);
    return values ? Result<void>() : values.error();
}

/// Bytes in binary files, in ascii ones floats from 0 to 1, which become bytes as in VTK.
Result<void> LegacyData::read_color_scalars() {
    Header header{scanner_.word(), std::string(values_.binary() ? legacy_bytes.name : legacy_floats.name), 1, tuples_};
    const auto components = values_.read_count("the number of components");
    if (!components) return components.error();
    header.components = *components;
    header.colors = !values_.binary();
    return read_array(header);
}

Result<void> LegacyData::read_texture_coordinates() {
    Header header{scanner_.word(), {}, 1, tuples_};
    const auto dimension = values_.read_count("the dimension");
    if (!dimension) return dimension.error();
    header.components = *dimension;
    header.type = type_in(scanner_.word());
    return read_array(header);
}

/// FIELD name count, then for each array: name components tuples type. Outside of point and cell data it belongs to the
/// whole file and is stepped over.
Result<void> LegacyData::read_field() {
    scanner_.word();
    const auto count = values_.read_count("the number of arrays");
    if (!count) return count.error();
    for (std::uint64_t arrays = 0; arrays < *count;) {
        if (scanner_.at_end()) {
            if (!has_geometry())
                return invalid_data(fmt::format("the file ends before array {} of {}", arrays, *count));
            if (!unread_)
                file_.notes.push_back(
                    fmt::format("a FIELD states {} arrays, but the file ends after {}", *count, arrays));
            return {};
        }
        if (!begins_array() && begins_section()) {
            if (lower(words_of_line(1).front()) != "metadata") {
                file_.notes.push_back(fmt::format("a FIELD states {} arrays, but has {}", *count, arrays));
                return {};
            }
            scanner_.word();
            read_metadata();
            continue;
        }
        const auto was_array = read_array_of_field(*count - arrays - 1);
        if (!was_array) return was_array.error();
        if (*was_array) ++arrays;
    }
    return {};
}

/// False where something else stood, which was stepped over.
Result<bool> LegacyData::read_array_of_field(std::uint64_t left) {
    const std::size_t start = scanner_.position();
    Header header;
    header.left_in_field = left;
    const auto words = words_of_line(most_words);
    header.name = read_name(is_line_of_array(words) ? 3 : words.empty() ? 1 : words.size() - 1);
    if (header.name == "NULL_ARRAY") return true;
    auto counts = [&]() -> Result<void> {
        const auto components = values_.read_count("the number of components");
        if (!components) return components.error();
        const auto tuples = values_.read_count("the number of tuples");
        if (!tuples) return tuples.error();
        header.components = *components;
        header.tuples = *tuples;
        header.type = type_in(scanner_.word());
        if (is_identifier(header.type)) return {};
        return values_.before_here(fmt::format("{} is not a type", in_quotes(header.type)));
    }();
    if (!counts && !may_go_on(counts.error())) return counts.error();
    if (!counts) scanner_.seek(start);
    const auto done = counts ? read_array(header) : lose(header.name, left + 1, counts.error());
    if (!done) return done.error();
    return static_cast<bool>(counts);
}

/// Values of an array with a name, which are kept if they are wanted.
Result<void> LegacyData::read_array(const Header& header) {
    expect_names(header.components);
    if (header.type == "string" || header.type == "utf8_string" || header.type == "variant")
        return skip_strings(header);
    const auto type = legacy_type(header.type);
    if (!type) {
        leave_out_array(header, fmt::format("its type {} is not known", in_quotes(header.type)));
        return skip_unknown_type(header);
    }
    const std::string name = decoded_name(header.name);
    const bool of_file = data_ == Data::none && !wants_.file_arrays.empty() && name.starts_with(wants_.file_arrays);
    const bool is_time = data_ == Data::none && (name == "TIME" || name == "TimeValue") && header.tuples == 1;
    const bool is_wanted = of_file || is_time || (data_ != Data::none && !name.empty() && wants_.field(association(), name));
    const bool stays = is_wanted && may_stay(name, *type, header);
    const std::size_t before = scanner_.position();
    auto values =
        values_.read_values(*type, header.tuples, header.components, in_quotes(header.name), is_wanted && !stays);
    if (!values) {
        if (!may_go_on(values.error())) return values.error();
        leave_out_array(header, values.error().message);
        return go_on_behind(header.left_in_field, values.error());
    }
    if (data_ == Data::none) {
        if (is_time && values->components() == 1) file_.info.times = time_values(*values);
        if (of_file) file_.field_data.push_back({name, *std::move(values)});
        return {};
    }
    if (is_wanted && header.colors) *values = bytes_of_colors(*values);
    const ScalarType stored = header.colors ? ScalarType::uint8 : type->widened ? ScalarType::int64 : type->type;
    found_.push_back({association(),
                      {name, std::move(*values), header.normals},
                      is_wanted,
                      stored,
                      header.components,
                      header.tuples});
    if (stays) {
        const std::uint64_t bytes = header.tuples * header.components * size_of(type->type);
        found_.back().in_file = {before, scanner_.position() - static_cast<std::size_t>(bytes), *type, header.tuples,
                                 header.components};
    }
    last_is_found_ = true;
    return {};
}

/// Strings: in ascii files a line each; in binary ones a length of 6, 14, 30 or 62 bits, then the characters. A variant
/// has a line in both.
Result<void> LegacyData::skip_strings(const Header& header) {
    const std::uint64_t components = header.components, tuples = header.tuples;
    if (wants_.tells_text) leave_out_array(header, "it holds text, not numbers");
    if (components == 0 || tuples > scanner_.left() / components)
        return invalid_data(fmt::format("{} x {} strings do not fit into the file", tuples, components));
    scanner_.next_line();
    const auto too_short = [] { return invalid_data("the file ends inside an array of strings"); };
    const bool lines = !values_.binary() || header.type == "variant";
    for (std::uint64_t i = 0; i < tuples * components; ++i) {
        if (scanner_.left() == 0) return too_short();
        if (lines) {
            scanner_.next_line();
            continue;
        }
        std::array<std::byte, 8> head{};
        const std::size_t at = scanner_.position();
        if (auto read = values_.source().read(at, std::span(head).first(std::min<std::size_t>(8, scanner_.left())));
            !read)
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

/// In a binary file values have the size behind which the file goes on as it should, if only one has.
Result<void> LegacyData::skip_unknown_type(const Header& header) {
    const Error error =
        values_.before_here(fmt::format("the type {} of the array {} is not known, nor how many bytes its values take",
                                        in_quotes(header.type), in_quotes(header.name)));
    if (!values_.binary()) return go_on_behind(header.left_in_field, error);
    scanner_.next_line();
    const std::size_t begin = scanner_.position(), left = scanner_.left();
    std::set<std::size_t> ends;
    for (const std::uint64_t size : {1, 2, 4, 8, 16}) {
        if (header.components == 0 || header.tuples > left / header.components / size) break;
        const auto end = begin + static_cast<std::size_t>(header.tuples * header.components * size);
        if (goes_on(end, header.left_in_field)) ends.insert(end);
    }
    scanner_.seek(ends.size() == 1 ? *ends.begin() : begin);
    return ends.size() == 1 ? Result<void>() : go_on_behind(0, error);
}

/// Puts symmetric tensors into VTK's order.
void LegacyData::order_as_named(std::span<const std::string> names) {
    if (!last_is_found_ || !found_.back().wanted || found_.back().components != names.size()) return;
    Array& values = found_.back().attribute.values;
    const auto order = order_of_names(names);
    if (found_.back().in_file) found_.back().in_file->order = order;
    else if (order) values = ordered_as_vtk(values, *order);
    last_is_found_ = false;
}

/// Up to an empty line. COMPONENT_NAMES has a line for each component, which may be empty, too.
void LegacyData::read_metadata() {
    scanner_.next_line();
    while (scanner_.left() > 0 && !scanner_.at_line_end()) {
        const std::string word = scanner_.word_of_line();
        if (word == "INFORMATION") {
            skip_information();
            continue;
        }
        scanner_.next_line();
        if (word != "COMPONENT_NAMES") continue;
        std::vector<std::string> names;
        for (std::uint64_t i = 0; i < names_ && scanner_.left() > 0; ++i) {
            const auto words = words_of_line(2); // a blank in a name is written as %20
            if (words.size() == 2 && words[0] == "INFORMATION") break;
            names.push_back(words.empty() ? std::string() : words[0]);
            scanner_.next_line();
        }
        order_as_named(names);
    }
}

/// INFORMATION count, then for each key a line with its name and one with its value; that of a list of strings is their
/// number, and a line for each, which may be empty.
void LegacyData::skip_information() {
    scanner_.next_line();
    while (scanner_.left() > 0 && !scanner_.at_line_end()) {
        const auto words = words_of_line(3);
        scanner_.next_line();
        std::uint64_t strings = 0;
        if (words.size() != 2 || words[0] != "DATA" || !parse_number(words[1], strings)) continue;
        const auto next = words_of_line(1);
        if (next.empty() || next[0] == "NAME") continue; // one number
        for (std::uint64_t i = 0; i < strings && scanner_.left() > 0; ++i) scanner_.next_line();
    }
}

/// True where this line begins with a keyword.
bool LegacyData::begins_section() {
    const auto words = words_of_line(1);
    if (words.empty()) return false;
    const std::string word = lower(words[0]);
    return is_section(word) || std::ranges::find(other_sections, word) != other_sections.end();
}

/// True where this line is what stands before the values of an array of a FIELD.
bool LegacyData::begins_array() {
    const auto words = words_of_line(most_words);
    return words.size() > 3 && is_line_of_array(words);
}

/// True where the file ends here, or goes on with a section, or an array where one is still to come.
bool LegacyData::goes_on(std::size_t position, std::uint64_t left_in_field) {
    scanner_.seek(position);
    return scanner_.at_end() || begins_section() || (left_in_field > 0 && begins_array());
}

/// Moves to the next line where the file goes on; false at the end.
bool LegacyData::seek_next(std::uint64_t left_in_field) {
    for (scanner_.next_line(); scanner_.left() > 0; scanner_.next_line())
        if (begins_section() || (left_in_field > 0 && begins_array())) return true;
    return false;
}

bool LegacyData::has_geometry() const {
    if (file_.dataset == "unstructured_grid") return file_.has_points && file_.cell_type_count > 0;
    if (file_.dataset == "polydata") return file_.has_points && file_.cells_announced() > 0;
    return !file_.dataset.empty() && file_.points_announced() > 0;
}

/// Whether the values of a cell field may be read when it is known of which cells.
bool LegacyData::may_stay(const std::string& name, const LegacyType& type, const Header& header) const {
    return wants_.leave && wants_.leave(name) && data_ == Data::cells && file_.cells.in_file && values_.binary() &&
           !type.bits && header.tuples > 0;
}

bool LegacyData::may_go_on(const Error& error) const {
    return error.code == ErrorCode::invalid_data && !scanner_.error();
}

void LegacyData::leave_out_array(const Header& header, std::string reason) {
    if (data_ != Data::none)
        leave_out(file_.info, {kind_of(association()), decoded_name(header.name), std::move(reason)});
}

/// Behind something that cannot be read, of unknown length.
Result<void> LegacyData::go_on_behind(std::uint64_t left_in_field, const Error& error) {
    if (!values_.binary() && ++faults_ < max_faults) {
        seek_next(left_in_field);
        return {};
    }
    if (!has_geometry()) return error;
    if (scanner_.left() > 0)
        file_.notes.push_back(fmt::format("what follows byte {} is not read", scanner_.position()));
    unread_ = true;
    scanner_.seek(values_.source().size());
    return {};
}

/// Where something else stands than what should follow the array before, whose length is then another one than it says.
Result<void> LegacyData::lose(const std::string& word, std::uint64_t left_in_field, const Error& error) {
    if (!found_.empty()) {
        const Found& last = found_.back();
        leave_out(file_.info, {kind_of(last.association), last.attribute.name,
                               fmt::format("{} stands behind its {} x {} values, where a section should begin",
                                           in_quotes(word), last.tuples, last.components)});
        found_.pop_back();
    }
    return go_on_behind(left_in_field, error);
}

void LegacyData::finish() {
    const std::uint64_t points = file_.points_announced(), cells = file_.cells_announced();
    for (Found& found : found_) {
        const bool point = found.association == Association::point;
        const std::string& name = found.attribute.name;
        if (name.empty()) {
            leave_out(file_.info, {kind_of(found.association), name, "it has no name"});
            continue;
        }
        if (found.tuples != (point ? points : cells)) {
            leave_out(file_.info, {kind_of(found.association), name,
                                   fmt::format("it has {} values, but the grid has {} {}", found.tuples,
                                               point ? points : cells, point ? "points" : "cells")});
            continue;
        }
        auto& attributes = point ? file_.point_data : file_.cell_data;
        const auto same = std::ranges::find_if(file_.info.fields, [&](const FieldInfo& field) {
            return field.association == found.association && field.name == name;
        });
        if (same != file_.info.fields.end()) {
            file_.notes.push_back(fmt::format("{} {} occurs twice: the values of the last one were taken",
                                              kind_of(found.association), in_quotes(name)));
            file_.info.fields.erase(same);
            std::erase_if(attributes, [&](const Attribute& attribute) { return attribute.name == name; });
            if (!point) file_.cell_values_in_file.erase(name);
        }
        const std::pair one(found.association, name);
        const bool marked = std::ranges::find(scalars_, one) != scalars_.end() && // VTK writes one so, others as FIELD
                            std::ranges::count(scalars_, one.first, &std::pair<Association, std::string>::first) == 1;
        announce(file_.info, {name, found.association, found.type, static_cast<std::size_t>(found.components), marked});
        if (found.in_file) file_.cell_values_in_file.emplace(name, *found.in_file);
        if (found.wanted) attributes.push_back(std::move(found.attribute));
    }
    found_.clear();
}

} // namespace isotet::io
