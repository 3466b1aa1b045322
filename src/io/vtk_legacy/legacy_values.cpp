// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/vtk_legacy/legacy_values.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <span>
#include <utility>

#include <fmt/core.h>

#include "base/errors.hpp"
#include "io/files/first_error.hpp"
#include "io/files/number_text.hpp"
#include "io/files/pace.hpp"
#include "io/files/scalars.hpp"
#include "io/pieces/narrow_indices.hpp"
#include "io/vtk_xml/stored_array.hpp"
#include "io/write/write_stream.hpp"

namespace isotet::io {
namespace {

constexpr std::uint64_t max_components = 1U << 20U;

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
                                  LegacyType{"long_long", ScalarType::int64},
                                  LegacyType{"__int64", ScalarType::int64},
                                  LegacyType{"unsigned_long", ScalarType::uint64},
                                  LegacyType{"unsigned_long_long", ScalarType::uint64},
                                  LegacyType{"unsigned___int64", ScalarType::uint64},
                                  LegacyType{"float", ScalarType::float32},
                                  LegacyType{"double", ScalarType::float64},
                                  LegacyType{"int8", ScalarType::int8},
                                  LegacyType{"uint8", ScalarType::uint8},
                                  LegacyType{"int16", ScalarType::int16},
                                  LegacyType{"uint16", ScalarType::uint16},
                                  LegacyType{"int32", ScalarType::int32},
                                  LegacyType{"uint32", ScalarType::uint32},
                                  LegacyType{"int64", ScalarType::int64},
                                  LegacyType{"uint64", ScalarType::uint64},
                                  LegacyType{"float32", ScalarType::float32},
                                  LegacyType{"float64", ScalarType::float64}};

} // namespace

std::string lower(std::string word) {
    for (char& c : word) {
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    }
    return word;
}

Error LegacyValues::before_here(std::string_view what) {
    return invalid_data(fmt::format("before byte {} ({}): {}", scanner_.position(), in_quotes(scanner_.here()), what));
}

Result<std::uint64_t> LegacyValues::read_count(std::string_view what) {
    std::uint64_t count = 0;
    if (!scanner_.number(count)) return before_here(fmt::format("{} is not a count", what));
    return count;
}

std::optional<LegacyType> legacy_type(std::string_view name) {
    if (name.starts_with("vtktype")) name.remove_prefix(7); // vtktypeint64 and so on
    const std::span<const LegacyType> all = legacy_types;   // an array's iterator is a pointer in some libraries only
    const auto known = std::ranges::find(all, name, &LegacyType::name);
    return known == all.end() ? std::nullopt : std::optional(*known);
}

Result<LegacyType> LegacyValues::read_type() {
    const auto name = lower(scanner_.word());
    const auto known = legacy_type(name);
    if (!known) return before_here(fmt::format("{} is not a type that is read", in_quotes(name)));
    return *known;
}

Result<void> LegacyValues::check_size(std::uint64_t tuples, std::uint64_t components, std::string_view what) const {
    if (components == 0 || components > max_components)
        return invalid_data(fmt::format("{} has {} components, not 1 to {}", what, components, max_components));
    if (tuples > std::numeric_limits<std::uint64_t>::max() / components / 8)
        return invalid_data(fmt::format("{}: {} tuples", what, tuples));
    return {};
}

Result<Array> LegacyValues::read_values(const LegacyType& type, std::uint64_t tuples, std::uint64_t components,
                                        std::string_view what, bool is_wanted) {
    if (tuples == 0 && components == 0) components = 1; // an array without values has no bytes
    if (auto sized = check_size(tuples, components, what); !sized) return sized.error();
    auto values = binary_ ? read_binary(type, tuples, components, what, is_wanted)
                          : read_ascii(type, tuples, components, what, is_wanted);
    if (!values || !is_wanted) return values;
    if (type.bits) return mapped<std::uint8_t>(*values, [](auto bit) { return std::uint8_t{bit != 0}; });
    if (!type.widened) return values;
    return mapped<std::int64_t>(*values, [](auto value) { return static_cast<std::int64_t>(value); });
}

Result<Array> LegacyValues::read_floating(const LegacyType& type, std::uint64_t tuples, std::uint64_t components,
                                          std::string_view what, bool is_wanted) {
    auto values = read_values(type, tuples, components, what, is_wanted);
    if (!values || values->data() == nullptr || is_floating(values->type())) return values;
    return mapped<double>(*values, [](auto value) { return static_cast<double>(value); });
}

Result<Array> LegacyValues::read_ascii(const LegacyType& type, std::uint64_t tuples, std::uint64_t components,
                                       std::string_view what, bool is_wanted) {
    const std::uint64_t count = tuples * components;
    if (count > scanner_.left() / 2 + 1)
        return invalid_data(fmt::format("{}: {} x {} numbers were announced, but only {} bytes are left", what, tuples,
                                        components, scanner_.left()));
    const auto read = [&](std::byte* to) -> Result<void> {
        const auto end =
            read_numbers(source_, scanner_.position(), source_.size(), type.type, count, what, to, progress_);
        if (!end) return end.error();
        scanner_.seek(*end);
        return {};
    };
    if (is_wanted)
        return vtk_xml::filled_array(type.type, static_cast<std::size_t>(tuples), static_cast<std::size_t>(components),
                                     read);
    if (auto done = read(nullptr); !done) return done.error();
    return Array();
}

Result<Array> LegacyValues::read_binary(const LegacyType& type, std::uint64_t tuples, std::uint64_t components,
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

Result<std::size_t> LegacyValues::skip(const LegacyType& type, std::uint64_t count, std::size_t size,
                                       std::string_view what) {
    if (auto sized = check_size(count, 1, what); !sized) return sized.error();
    if (auto skipped = read_binary(type, count, 1, what, false); !skipped) return skipped.error();
    return scanner_.position() - static_cast<std::size_t>(count) * size;
}

std::byte* LegacyValues::passing_room(std::size_t bytes) {
    thread_local Scratch scratch;
    return scratch.take(bytes).data();
}

Result<void> LegacyValues::each_stored_piece(std::size_t begin, std::uint64_t count, std::size_t size, const Room& room,
                                             const Take& take) {
    FirstError failed;
    std::atomic<bool> goes_on = true;
    core::parallel_pieces(static_cast<std::size_t>(count), legacy_piece, progress_,
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

Result<void> LegacyValues::each_piece(std::size_t begin, std::uint64_t count, std::size_t size, const Room& room,
                                      const Take& take) {
    return each_stored_piece(begin, count, size, room, [&](std::size_t first, std::span<std::byte> piece) {
        if (std::endian::native != std::endian::big) swap_bytes(piece.data(), piece.size() / size, size);
        return take(first, piece);
    });
}

Result<std::optional<Array>> LegacyValues::read_narrow(const LegacyType& type, std::uint64_t count,
                                                       std::string_view what) {
    constexpr std::size_t size = sizeof(std::int64_t);
    const std::size_t before = scanner_.position();
    const auto begin = skip(type, count, size, what);
    if (!begin) return begin.error();
    NarrowIndices narrow(static_cast<std::size_t>(count));
    auto done = each_stored_piece(
        *begin, count, size, [](std::size_t, std::size_t values) { return passing_room(values * size); },
        [&](std::size_t first, std::span<const std::byte> piece) {
            narrow.add_big_endian(first, piece);
            return true;
        });
    if (!done) return done.error();
    auto array = std::move(narrow).to_array();
    if (!array) scanner_.seek(before);
    return array;
}

Result<Array> LegacyValues::read_bits(std::size_t begin, std::size_t bytes, std::uint64_t tuples,
                                      std::uint64_t components) {
    Scratch scratch;
    const auto packed = source_.view(begin, bytes, scratch);
    if (!packed) return packed.error();
    return vtk_xml::filled_array(
        ScalarType::uint8, static_cast<std::size_t>(tuples), static_cast<std::size_t>(components), [&](std::byte* to) {
            for (std::uint64_t i = 0; i < tuples * components; ++i)
                to[i] = (static_cast<std::byte>((*packed)[i / 8]) >> (7 - i % 8)) & std::byte{1};
            return Result<void>();
        });
}

} // namespace isotet::io
