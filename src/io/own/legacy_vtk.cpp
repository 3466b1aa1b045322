// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/own/legacy_vtk.hpp"

#include <algorithm>
#include <atomic>
#include <charconv>
#include <limits>
#include <optional>
#include <utility>

#include <fmt/core.h>

#include "core/errors.hpp"
#include "core/parallel.hpp"
#include "io/own/first_error.hpp"
#include "io/own/loaded.hpp"
#include "io/own/narrow_indices.hpp"
#include "io/own/number_text.hpp"
#include "io/own/pace.hpp"
#include "io/own/source_scanner.hpp"
#include "io/own/surface_scalars.hpp"
#include "io/own/vtk_xml/stored_array.hpp"
#include "io/own/write_stream.hpp"

namespace isotet::io {
namespace {

constexpr std::uint64_t max_components = 1U << 20U;
constexpr std::size_t piece_values = std::size_t{1} << 16; ///< of 8 bytes they stay in a processor's own cache

/// A type of values, and how they are stored.
struct LegacyType {
    std::string_view name;
    ScalarType type;
    bool bits = false;    ///< in binary files eight to a byte; they become uint8
    bool widened = false; ///< to int64
};
// vtkIdType is written as int, whatever its size in memory; long has the 8 bytes that it has on 64-bit Unix.
constexpr std::array legacy_types{LegacyType{"char", ScalarType::int8},
                                  LegacyType{"signed_char", ScalarType::int8},
                                  LegacyType{"unsigned_char", ScalarType::uint8},
                                  LegacyType{"bit", ScalarType::uint8, true},
                                  LegacyType{"short", ScalarType::int16},
                                  LegacyType{"unsigned_short", ScalarType::uint16},
                                  LegacyType{"int", ScalarType::int32},
                                  LegacyType{"vtkidtype", ScalarType::int32, false, true},
                                  LegacyType{"unsigned_int", ScalarType::uint32},
                                  LegacyType{"long", ScalarType::int64},
                                  LegacyType{"vtktypeint64", ScalarType::int64},
                                  LegacyType{"unsigned_long", ScalarType::uint64},
                                  LegacyType{"vtktypeuint64", ScalarType::uint64},
                                  LegacyType{"float", ScalarType::float32},
                                  LegacyType{"double", ScalarType::float64}};
constexpr LegacyType integers{"int", ScalarType::int32}, bytes_type{"unsigned_char", ScalarType::uint8},
    floats{"float", ScalarType::float32};

std::string lower(std::string word) {
    for (char& c : word) {
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    }
    return word;
}

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

template <class To, class Convert>
Array mapped(const Array& from, const Convert& convert) {
    core::Buffer<To> to(from.size());
    from.visit([&](auto values) {
        core::parallel_each(values.size(), piece_values, [&](std::size_t i) { to[i] = convert(values[i]); });
    });
    return std::move(to).to_array(from.components());
}

class LegacyReader {
public:
    LegacyReader(const ByteSource& source, const LegacyWants& wants, const Progress& progress)
        : source_(source), scanner_(source), wants_(wants), progress_(progress) {}

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

    Error before_here(std::string_view what) {
        return invalid_data(
            fmt::format("before byte {} ({}): {}", scanner_.position(), in_quotes(scanner_.here()), what));
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
        binary_ = form == "binary";
        return {};
    }

    Result<void> read_section(const std::string& keyword) {
        if (keyword == "dataset") return read_dataset();
        if (keyword == "field") return read_field();
        if (keyword == "metadata") return skip_metadata();
        if (file_.dataset.empty()) return invalid_data(fmt::format("{} before DATASET", in_quotes(keyword)));
        if (keyword == "points") return read_points();
        if (keyword == "vertices") return read_cells(file_.vertices, keyword);
        if (keyword == "lines") return read_cells(file_.lines, keyword);
        if (keyword == "polygons") return read_cells(file_.polygons, keyword);
        if (keyword == "triangle_strips") return read_cells(file_.strips, keyword);
        if (keyword == "cells") return read_cells(file_.cells, keyword);
        if (keyword == "cell_types") return read_cell_types();
        if (keyword == "dimensions") return read_dimensions();
        if (keyword == "origin") return read_three(file_.origin, keyword);
        if (keyword == "spacing" || keyword == "aspect_ratio") return read_three(file_.spacing, keyword);
        for (std::size_t axis = 0; axis < 3; ++axis)
            if (keyword == std::string(1, "xyz"[axis]) + "_coordinates") return read_coordinates(axis, keyword);
        if (keyword == "cell_data") return start_data(Data::cells);
        if (keyword == "point_data") return start_data(Data::points);
        return read_attribute(keyword);
    }

    Result<void> read_dataset() {
        const auto kind = lower(scanner_.word());
        if (!wants_.dataset(kind)) return invalid_data(fmt::format("this is a dataset of kind {}", in_quotes(kind)));
        file_.dataset = kind;
        return {};
    }

    Result<std::uint64_t> read_count(std::string_view what) {
        std::uint64_t count = 0;
        if (!scanner_.number(count)) return before_here(fmt::format("{} is not a count", what));
        return count;
    }

    Result<LegacyType> read_type() {
        const auto name = lower(scanner_.word());
        const auto* const known = std::ranges::find(legacy_types, name, &LegacyType::name);
        if (known == legacy_types.end())
            return before_here(fmt::format("{} is not a type that is read", in_quotes(name)));
        return *known;
    }

    Result<void> check_size(std::uint64_t tuples, std::uint64_t components, std::string_view what) const {
        if (components == 0 || components > max_components)
            return invalid_data(fmt::format("{} has {} components, not 1 to {}", what, components, max_components));
        if (tuples > std::numeric_limits<std::uint64_t>::max() / components / 8)
            return invalid_data(fmt::format("{}: {} tuples", what, tuples));
        return {};
    }

    /// Values from the next line on, in binary files big endian. Empty where they are not wanted.
    Result<Array> read_values(const LegacyType& type, std::uint64_t tuples, std::uint64_t components,
                              std::string_view what, bool is_wanted) {
        if (auto sized = check_size(tuples, components, what); !sized) return sized.error();
        auto values = binary_ ? read_binary(type, tuples, components, what, is_wanted)
                              : read_ascii(type, tuples, components, what, is_wanted);
        if (!values || !is_wanted) return values;
        if (type.bits) return mapped<std::uint8_t>(*values, [](auto bit) { return std::uint8_t{bit != 0}; });
        if (!type.widened) return values;
        return mapped<std::int64_t>(*values, [](auto value) { return static_cast<std::int64_t>(value); });
    }

    Result<Array> read_ascii(const LegacyType& type, std::uint64_t tuples, std::uint64_t components,
                             std::string_view what, bool is_wanted) {
        const std::uint64_t count = tuples * components;
        if (count > scanner_.left() / 2 + 1)
            return invalid_data(fmt::format("{}: {} x {} numbers were announced, but only {} bytes are left", what,
                                            tuples, components, scanner_.left()));
        const auto read = [&](std::byte* to) -> Result<void> {
            const auto end =
                read_numbers(source_, scanner_.position(), source_.size(), type.type, count, what, to, progress_);
            if (!end) return end.error();
            scanner_.seek(*end);
            return {};
        };
        if (is_wanted)
            return vtk_xml::filled_array(type.type, static_cast<std::size_t>(tuples),
                                         static_cast<std::size_t>(components), read);
        if (auto done = read(nullptr); !done) return done.error();
        return Array();
    }

    Result<Array> read_binary(const LegacyType& type, std::uint64_t tuples, std::uint64_t components,
                              std::string_view what, bool is_wanted) {
        scanner_.next_line();
        const std::uint64_t count = tuples * components, size = size_of(type.type);
        const std::uint64_t bytes = type.bits ? (count + 7) / 8 : count * size;
        if (bytes > scanner_.left())
            return invalid_data(fmt::format("{}: {} x {} {} were announced, but only {} bytes are left", what, tuples,
                                            components, type.name, scanner_.left()));
        const std::size_t begin = scanner_.position();
        scanner_.seek(begin + static_cast<std::size_t>(bytes));
        if (!is_wanted) return Array();
        if (type.bits) return read_bits(begin, static_cast<std::size_t>(bytes), tuples, components);
        return vtk_xml::filled_array(
            type.type, static_cast<std::size_t>(tuples), static_cast<std::size_t>(components), [&](std::byte* to) {
                return each_piece(
                    begin, count, size, [&](std::size_t first, std::size_t) { return to + first * size; },
                    [](std::size_t, std::span<const std::byte>) { return true; });
            });
    }

    /// Reads `count` values of `size` bytes from `begin` on, in parallel, into room(first, count), as they are stored; then
    /// calls take(first, bytes), which says whether to go on.
    template <class Room, class Take>
    Result<void> each_stored_piece(std::size_t begin, std::uint64_t count, std::size_t size, const Room& room,
                                   const Take& take) {
        FirstError failed;
        std::atomic<bool> goes_on = true;
        core::parallel_pieces(static_cast<std::size_t>(count), piece_values, progress_,
                              [&](std::size_t first, std::size_t end) {
                                  if (!goes_on) return;
                                  const std::span<std::byte> piece(room(first, end - first), (end - first) * size);
                                  if (auto read = source_.read(begin + first * size, piece); !read)
                                      return failed.add(first, read.error());
                                  if (!take(first, piece)) goes_on = false;
                              });
        if (progress_.cancelled()) failed.add(0, Pace::cancelled());
        return failed.result();
    }

    /// The same in the byte order of this machine.
    template <class Room, class Take>
    Result<void> each_piece(std::size_t begin, std::uint64_t count, std::size_t size, const Room& room,
                            const Take& take) {
        return each_stored_piece(begin, count, size, room, [&](std::size_t first, std::span<std::byte> piece) {
            if (std::endian::native != std::endian::big) swap_bytes(piece.data(), piece.size() / size, size);
            return take(first, std::span<const std::byte>(piece));
        });
    }

    /// Indices of 64 bits in a binary file as int32; nothing, and the place as before, where one does not fit.
    Result<std::optional<Array>> read_narrow(const LegacyType& type, std::uint64_t count, std::string_view what) {
        const std::size_t before = scanner_.position();
        if (auto sized = check_size(count, 1, what); !sized) return sized.error();
        if (auto skipped = read_binary(type, count, 1, what, false); !skipped) return skipped.error();
        const std::size_t bytes = static_cast<std::size_t>(count) * sizeof(std::int64_t);
        NarrowIndices narrow(static_cast<std::size_t>(count));
        auto done = each_stored_piece(
            scanner_.position() - bytes, count, sizeof(std::int64_t),
            [](std::size_t, std::size_t values) {
                thread_local Scratch scratch;
                return scratch.take(values * sizeof(std::int64_t)).data();
            },
            [&](std::size_t first, std::span<const std::byte> piece) {
                narrow.add_big_endian(first, piece);
                return true;
            });
        if (!done) return done.error();
        auto array = std::move(narrow).to_array();
        if (!array) scanner_.seek(before);
        return array;
    }

    Result<Array> read_bits(std::size_t begin, std::size_t bytes, std::uint64_t tuples, std::uint64_t components) {
        Scratch scratch;
        const auto packed = source_.view(begin, bytes, scratch);
        if (!packed) return packed.error();
        return vtk_xml::filled_array(ScalarType::uint8, static_cast<std::size_t>(tuples),
                                     static_cast<std::size_t>(components), [&](std::byte* to) {
                                         for (std::uint64_t i = 0; i < tuples * components; ++i)
                                             to[i] = (static_cast<std::byte>((*packed)[i / 8]) >> (7 - i % 8)) &
                                                     std::byte{1};
                                         return Result<void>();
                                     });
    }

    Result<Array> floating(Result<Array> values) const {
        if (!values || values->data() == nullptr || is_floating(values->type())) return values;
        return mapped<double>(*values, [](auto value) { return static_cast<double>(value); });
    }

    Result<void> read_points() {
        if (file_.has_points) return before_here("POINTS occurs twice");
        const auto count = read_count("the number of points");
        if (!count) return count.error();
        const auto type = read_type();
        if (!type) return type.error();
        auto points = floating(read_values(*type, *count, 3, "POINTS", wants_.geometry));
        if (!points) return points.error();
        file_.points = std::move(*points);
        file_.has_points = true;
        return {};
    }

    Result<void> read_cell_types() {
        const auto count = read_count("the number of cell types");
        if (!count) return count.error();
        file_.cell_type_count = *count;
        if (binary_ && wants_.geometry) {
            const auto one = read_one_type(*count);
            if (!one) return one.error();
            file_.one_type = *one;
            if (*one) return {};
        }
        const auto types = read_values(integers, *count, 1, "CELL_TYPES", wants_.geometry);
        if (!types) return types.error();
        std::atomic<bool> fit = true;
        file_.cell_types = mapped<std::uint8_t>(*types, [&](auto type) {
            if (type < 0 || type > 255) fit = false;
            return static_cast<std::uint8_t>(type);
        });
        if (!fit) return invalid_data("CELL_TYPES: a type is not between 0 and 255");
        return {};
    }

    /// The type of all cells of a binary file; nothing, and the place as before, where there are several.
    Result<std::optional<std::uint8_t>> read_one_type(std::uint64_t count) {
        constexpr std::int32_t unknown = -1;
        std::atomic<std::int32_t> first = unknown;
        const auto same = read_while<std::int32_t>(
            integers, count, "CELL_TYPES", [&](std::size_t, std::span<const std::int32_t> types) {
                const std::int32_t own = types.front();
                std::int32_t expected = unknown, different = 0;
                if (!first.compare_exchange_strong(expected, own) && expected != own) return false;
                for (const std::int32_t type : types) different |= type ^ own;
                return different == 0 && own >= 0 && own <= 255;
            });
        if (!same) return same.error();
        return *same && count > 0 ? std::optional(static_cast<std::uint8_t>(first.load())) : std::nullopt;
    }

    /// Looks at the values of a binary file piece by piece, in parallel, and keeps none of them. False, and the place as
    /// before, where look(first, values) says false of some.
    template <class Value, class Look>
    Result<bool> read_while(const LegacyType& type, std::uint64_t count, std::string_view what, const Look& look) {
        const std::size_t before = scanner_.position();
        if (auto sized = check_size(count, 1, what); !sized) return sized.error();
        if (auto skipped = read_binary(type, count, 1, what, false); !skipped) return skipped.error();
        std::atomic<bool> all = true;
        auto done = each_piece(
            scanner_.position() - static_cast<std::size_t>(count) * sizeof(Value), count, sizeof(Value),
            [](std::size_t, std::size_t values) {
                thread_local Scratch scratch;
                return scratch.take(values * sizeof(Value)).data();
            },
            [&](std::size_t first, std::span<const std::byte> piece) {
                const auto* const values = reinterpret_cast<const Value*>(piece.data());
                if (!look(first, std::span(values, piece.size() / sizeof(Value)))) all = false;
                return all.load();
            });
        if (!done) return done.error();
        if (!all) scanner_.seek(before);
        return all.load();
    }

    Result<void> read_dimensions() {
        for (std::uint64_t& count : file_.dimensions)
            if (!scanner_.number(count) || count > std::numeric_limits<std::int32_t>::max())
                return before_here("DIMENSIONS are not three counts");
        return {};
    }

    Result<void> read_three(std::array<double, 3>& numbers, std::string_view keyword) {
        for (double& number : numbers)
            if (!scanner_.number(number)) return before_here(fmt::format("{} is not three numbers", keyword));
        return {};
    }

    Result<void> read_coordinates(std::size_t axis, std::string_view keyword) {
        const auto count = read_count("the number of coordinates");
        if (!count) return count.error();
        const auto type = read_type();
        if (!type) return type.error();
        auto values = floating(read_values(*type, *count, 1, keyword, wants_.geometry));
        if (!values) return values.error();
        file_.coordinates[axis] = std::move(*values);
        return {};
    }

    Result<void> read_cells(LegacyCells& cells, std::string_view keyword) {
        if (cells.count > 0) return before_here(fmt::format("{} occurs twice", keyword));
        const auto first = read_count("the number of cells"), second = read_count("the size of the cells");
        if (!first) return first.error();
        if (!second) return second.error();
        const auto before = scanner_.position();
        const bool has_offsets = lower(scanner_.word()) == "offsets";
        if (has_offsets) return read_offsets(cells, keyword, *first, *second);
        scanner_.seek(before);
        if (*first == 0 && *second == 0) return {};
        return read_interleaved(cells, keyword, *first, *second);
    }

    /// Until version 4.2: count, corner, corner, ..., count, ...
    Result<void> read_interleaved(LegacyCells& cells, std::string_view keyword, std::uint64_t count,
                                  std::uint64_t size) {
        const auto values = read_values(integers, size, 1, keyword, wants_.geometry);
        if (!values) return values.error();
        if (!wants_.geometry) return {};
        const auto numbers = values->as<std::int32_t>();
        const auto does_not_fit = [&](std::uint64_t cell) {
            return invalid_data(
                fmt::format("{}: cell {} of {} does not fit into the {} numbers", keyword, cell, count, size));
        };
        if (count > size) return does_not_fit(size);
        cells.count = count;
        cells.interleaved = true;
        if (take_regular(cells, numbers)) return {};
        core::Buffer<std::int32_t> corners(numbers.size());
        core::Buffer<std::int64_t> offsets(static_cast<std::size_t>(count) + 1);
        std::size_t at = 0, next = 0;
        for (std::uint64_t cell = 0; cell < count; ++cell) {
            if (at >= numbers.size() || numbers[at] < 0 ||
                static_cast<std::size_t>(numbers[at]) > numbers.size() - at - 1)
                return does_not_fit(cell);
            const auto length = static_cast<std::size_t>(numbers[at]);
            offsets[cell] = static_cast<std::int64_t>(next);
            std::copy_n(numbers.data() + at + 1, length, corners.data() + next);
            next += length;
            at += length + 1;
        }
        offsets[count] = static_cast<std::int64_t>(next);
        corners.shrink(next);
        cells.connectivity = std::move(corners).to_array();
        cells.offsets = std::move(offsets).to_array();
        return {};
    }

    /// Cells that all have as many corners as the first.
    static bool take_regular(LegacyCells& cells, std::span<const std::int32_t> numbers) {
        const auto count = static_cast<std::size_t>(cells.count);
        if (count == 0 || numbers[0] < 1 || numbers.size() / count != static_cast<std::size_t>(numbers[0]) + 1 ||
            numbers.size() % count != 0)
            return false;
        const auto corners = static_cast<std::size_t>(numbers[0]);
        std::atomic<bool> regular = true;
        core::Buffer<std::int32_t> connectivity(count * corners);
        core::parallel_ranges(count, piece_values, [&](std::size_t begin, std::size_t end) {
            bool same = true;
            for (std::size_t cell = begin; cell < end; ++cell) {
                const std::int32_t* const from = numbers.data() + cell * (corners + 1);
                same = same && from[0] == numbers[0];
                std::copy_n(from + 1, corners, connectivity.data() + cell * corners);
            }
            if (!same) regular = false;
        });
        if (!regular) return false;
        cells.connectivity = std::move(connectivity).to_array();
        cells.corners = corners;
        return true;
    }

    /// From version 5.1 on: all offsets, one more than there are cells, then all corners.
    Result<void> read_offsets(LegacyCells& cells, std::string_view keyword, std::uint64_t count, std::uint64_t size) {
        for (Array* const numbers : {&cells.offsets, &cells.connectivity}) {
            const bool first = numbers == &cells.offsets;
            if (!first)
                if (const auto word = lower(scanner_.word()); word != "connectivity")
                    return invalid_data(
                        fmt::format("{}: {} where connectivity was expected", keyword, in_quotes(word)));
            const auto type = read_type();
            if (!type) return type.error();
            if (is_floating(type->type) || size_of(type->type) < 4)
                return invalid_data(fmt::format("{}: offsets or connectivity of type {}", keyword, type->name));
            const std::uint64_t needed = first ? count : size;
            if (first && binary_ && wants_.geometry && count > 1) {
                const auto corners = read_regular(*type, count, size, keyword);
                if (!corners) return corners.error();
                cells.corners = *corners;
                if (*corners > 0) continue;
            }
            if (binary_ && wants_.geometry && NarrowIndices::narrows(type->type)) {
                auto narrow = read_narrow(*type, needed, keyword);
                if (!narrow) return narrow.error();
                if (*narrow) {
                    *numbers = **std::move(narrow);
                    continue;
                }
            }
            auto values = read_values(*type, needed, 1, keyword, wants_.geometry);
            if (!values) return values.error();
            *numbers = std::move(*values);
        }
        if (!wants_.geometry) return {};
        cells.count = count == 0 ? 0 : count - 1;
        if (cells.count == 0 || cells.corners > 0) return {};
        FirstError failed;
        cells.offsets.visit([&](auto offsets) {
            core::parallel_ranges(offsets.size(), piece_values, [&](std::size_t begin, std::size_t end) {
                auto last = begin == 0 ? 0 : static_cast<std::uint64_t>(offsets[begin - 1]);
                for (std::size_t i = begin; i < end && !failed; ++i) {
                    const auto offset = static_cast<std::uint64_t>(offsets[i]);
                    if (offset > size || offset < last || (i == 0 && offset != 0))
                        failed.add(
                            i, invalid_data(fmt::format("{}: offsets[{}] is {}, outside 0 to {} or lower than before",
                                                        keyword, i, offsets[i], size)));
                    last = offset;
                }
            });
        });
        return failed.result();
    }

    /// How many corners each cell has; 0, and the place as before, where not all have as many, one after another.
    Result<std::uint64_t> read_regular(const LegacyType& type, std::uint64_t count, std::uint64_t size,
                                       std::string_view what) {
        const std::uint64_t corners = size / (count - 1);
        if (corners == 0 || size % (count - 1) != 0 || type.bits) return std::uint64_t{0};
        const auto look = [&]<class Offset>(std::size_t first, std::span<const Offset> offsets) {
            std::uint64_t different = 0;
            for (std::size_t i = 0; i < offsets.size(); ++i)
                different |= static_cast<std::uint64_t>(offsets[i]) ^ ((first + i) * corners);
            return different == 0;
        };
        const auto regular = size_of(type.type) == 8 ? read_while<std::int64_t>(type, count, what, look)
                                                     : read_while<std::int32_t>(type, count, what, look);
        if (!regular) return regular.error();
        return *regular ? corners : 0;
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

    Result<void> read_attribute(const std::string& keyword) {
        if (data_ == Data::none)
            return before_here(fmt::format("{} is not a section of {}", in_quotes(keyword), file_.dataset));
        if (keyword == "scalars") return read_scalar_attribute();
        if (keyword == "lookup_table") return read_lookup_table();
        if (keyword == "color_scalars") return read_color_scalars();
        if (keyword == "vectors" || keyword == "normals") return read_named(3, keyword == "normals");
        if (keyword == "tensors") return read_named(9, false);
        if (keyword == "tensors6") return read_named(6, false);
        if (keyword == "global_ids" || keyword == "pedigree_ids" || keyword == "edge_flags")
            return read_named(1, false);
        if (keyword == "texture_coordinates") return read_texture_coordinates();
        return before_here(fmt::format("{} is not an attribute that is read", in_quotes(keyword)));
    }

    /// Values of an array with a name, which is announced, and kept if it is wanted.
    /// Of two of one name the last counts.
    Result<void> read_array(const std::string& word, const LegacyType& type, std::uint64_t tuples,
                            std::uint64_t components, bool normals = false) {
        const Association association = data_ == Data::points ? Association::point : Association::cell;
        const std::string name = decoded_name(word);
        const bool is_wanted = data_ != Data::none && wants_.field(association, name);
        auto values = read_values(type, tuples, components, in_quotes(word), is_wanted);
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
        const auto type = read_type();
        if (!type) return type.error();
        return read_array(name, *type, tuples_, components, normals);
    }

    Result<void> read_scalar_attribute() {
        const std::string name = scanner_.word();
        const auto type = read_type();
        if (!type) return type.error();
        std::uint64_t components = 1;
        if (!scanner_.at_line_end() && !scanner_.number_of_line(components))
            return before_here("not a number of components");
        const auto before = scanner_.position();
        if (lower(scanner_.word()) == "lookup_table") scanner_.word_of_line(); // its name; it is optional
        else scanner_.seek(before);
        return read_array(name, *type, tuples_, components);
    }

    /// Colours for drawing: stepped over. Bytes in binary files, floats in ascii ones.
    Result<void> read_lookup_table() {
        scanner_.word();
        const auto count = read_count("the size of the table");
        if (!count) return count.error();
        const auto values = read_values(binary_ ? bytes_type : floats, *count, 4, "LOOKUP_TABLE", false);
        if (!values) return values.error();
        return {};
    }

    /// Bytes in binary files, in ascii ones floats from 0 to 1, which become bytes as in VTK.
    Result<void> read_color_scalars() {
        const std::string name = scanner_.word();
        const auto components = read_count("the number of components");
        if (!components) return components.error();
        if (auto read = read_array(name, binary_ ? bytes_type : floats, tuples_, *components); !read || binary_)
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
        const auto dimension = read_count("the dimension");
        if (!dimension) return dimension.error();
        const auto type = read_type();
        if (!type) return type.error();
        return read_array(name, *type, tuples_, *dimension);
    }

    /// FIELD name count, then for each array: name components tuples type. Outside of point and cell data it belongs to
    /// the whole file and is stepped over.
    Result<void> read_field() {
        scanner_.word();
        const auto count = read_count("the number of arrays");
        if (!count) return count.error();
        for (std::uint64_t i = 0; i < *count; ++i) {
            std::string name = scanner_.word();
            while (lower(name) == "metadata") {
                if (auto skipped = skip_metadata(); !skipped) return skipped;
                name = scanner_.word();
            }
            if (name.empty()) return invalid_data(fmt::format("the file ends before array {} of {}", i, *count));
            if (name == "NULL_ARRAY") continue;
            const auto components = read_count("the number of components"), tuples = read_count("the number of tuples");
            if (!components) return components.error();
            if (!tuples) return tuples.error();
            const auto before = scanner_.position();
            const auto type_name = lower(scanner_.word());
            if (type_name == "string" || type_name == "utf8_string") {
                if (auto skipped = skip_strings(*components, *tuples); !skipped) return skipped;
                continue;
            }
            scanner_.seek(before);
            const auto type = read_type();
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
            if (!binary_) {
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
    SourceScanner scanner_;
    const LegacyWants& wants_;
    const Progress& progress_;
    bool binary_ = false;
    Data data_ = Data::none;
    std::uint64_t tuples_ = 0;
    LegacyFile file_;
};

} // namespace

void LegacyCells::each(const std::function<void(std::span<const std::uint64_t>)>& visit) const {
    std::vector<std::uint64_t> cell;
    connectivity.visit([&](auto all) {
        const auto add = [&](std::size_t begin, std::size_t end) {
            cell.clear();
            for (std::size_t i = begin; i < end; ++i) cell.push_back(static_cast<std::uint64_t>(all[i]));
            visit(cell);
        };
        if (offsets.empty())
            for (std::size_t i = 0; i < count; ++i)
                add(i * static_cast<std::size_t>(corners), (i + 1) * static_cast<std::size_t>(corners));
        else
            offsets.visit([&](auto begins) {
                for (std::size_t i = 0; i + 1 < begins.size(); ++i)
                    add(static_cast<std::size_t>(begins[i]), static_cast<std::size_t>(begins[i + 1]));
            });
    });
}

Result<LegacyFile> read_legacy_vtk(const ByteSource& source, const LegacyWants& wants, const Progress& progress) {
    return LegacyReader(source, wants, progress).read();
}

} // namespace isotet::io
