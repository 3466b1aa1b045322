// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Values and words of legacy VTK files, ascii and binary, from where the reader stands.
#pragma once

#include <array>
#include <atomic>
#include <bit>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <isotet/array.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>

#include "base/buffer.hpp"
#include "base/parallel.hpp"
#include "io/files/byte_source.hpp"
#include "io/files/source_scanner.hpp"

namespace isotet::io {

/// A type of values, and how they are stored.
struct LegacyType {
    std::string_view name;
    ScalarType type;
    bool bits = false;    ///< in binary files eight to a byte; they become uint8
    bool widened = false; ///< to int64
};
constexpr LegacyType legacy_integers{"int", ScalarType::int32}, legacy_bytes{"unsigned_char", ScalarType::uint8},
    legacy_floats{"float", ScalarType::float32};

constexpr std::size_t legacy_piece = std::size_t{1} << 16; ///< values: of 8 bytes they stay in a processor's own cache

/// In lower case.
std::string lower(std::string word);

/// The type that VTK's legacy files, of any age, or other programs call so, in lower case.
std::optional<LegacyType> legacy_type(std::string_view name);

/// An array of the same shape of what convert() makes of each value.
template <class To, class Convert>
Array mapped(const Array& from, const Convert& convert) {
    core::Buffer<To> to(from.size());
    from.visit([&](auto values) {
        core::parallel_each(values.size(), legacy_piece, [&](std::size_t i) { to[i] = convert(values[i]); });
    });
    return std::move(to).to_array(from.components());
}

/// Reads one thing after another. A broken file is an error that says where; scanner().error() comes first.
class LegacyValues {
public:
    LegacyValues(const ByteSource& source, const Progress& progress)
        : source_(source), scanner_(source), progress_(progress) {}

    const ByteSource& source() const { return source_; }
    SourceScanner& scanner() { return scanner_; }
    bool binary() const { return binary_; }
    void set_binary(bool binary) { binary_ = binary; }

    /// invalid_data, with where the reader stands.
    Error before_here(std::string_view what);

    Result<std::uint64_t> read_count(std::string_view what);
    Result<LegacyType> read_type();

    /// Values from the next line on, in binary files big endian. Empty where they are not wanted.
    Result<Array> read_values(const LegacyType& type, std::uint64_t tuples, std::uint64_t components,
                              std::string_view what, bool is_wanted);

    /// The same, integers as float64.
    Result<Array> read_floating(const LegacyType& type, std::uint64_t tuples, std::uint64_t components,
                                std::string_view what, bool is_wanted);

    /// Indices of 64 bits in a binary file as int32; nothing, and the place as before, where one does not fit.
    Result<std::optional<Array>> read_narrow(const LegacyType& type, std::uint64_t count, std::string_view what);

    /// Looks at the values of a binary file piece by piece, in parallel, and keeps none of them. False, and the place as
    /// before, where look(first, values) says false of some.
    template <class Value, class Look>
    Result<bool> read_while(const LegacyType& type, std::uint64_t count, std::string_view what, const Look& look);

private:
    Result<void> check_size(std::uint64_t tuples, std::uint64_t components, std::string_view what) const;
    Result<Array> read_ascii(const LegacyType& type, std::uint64_t tuples, std::uint64_t components,
                             std::string_view what, bool is_wanted);
    Result<Array> read_binary(const LegacyType& type, std::uint64_t tuples, std::uint64_t components,
                              std::string_view what, bool is_wanted);
    Result<Array> read_bits(std::size_t begin, std::size_t bytes, std::uint64_t tuples, std::uint64_t components);

    /// Steps over `count` values of `size` bytes; returns where they begin.
    Result<std::size_t> skip(const LegacyType& type, std::uint64_t count, std::size_t size, std::string_view what);

    /// Reads `count` values of `size` bytes from `begin` on, in parallel, into room(first, count), as they are stored; then
    /// calls take(first, bytes), which says whether to go on.
    using Room = std::function<std::byte*(std::size_t first, std::size_t count)>;
    using Take = std::function<bool(std::size_t first, std::span<std::byte> bytes)>;
    Result<void> each_stored_piece(std::size_t begin, std::uint64_t count, std::size_t size, const Room& room,
                                   const Take& take);
    /// The same in the byte order of this machine.
    Result<void> each_piece(std::size_t begin, std::uint64_t count, std::size_t size, const Room& room,
                            const Take& take);

    /// Memory of this thread, for a piece that is only looked at.
    static std::byte* passing_room(std::size_t bytes);

    const ByteSource& source_;
    SourceScanner scanner_;
    const Progress& progress_;
    bool binary_ = false;
};

template <class Value, class Look>
Result<bool> LegacyValues::read_while(const LegacyType& type, std::uint64_t count, std::string_view what,
                                      const Look& look) {
    const std::size_t before = scanner_.position();
    const auto begin = skip(type, count, sizeof(Value), what);
    if (!begin) return begin.error();
    std::atomic<bool> all = true;
    auto done = each_piece(
        *begin, count, sizeof(Value),
        [](std::size_t, std::size_t values) { return passing_room(values * sizeof(Value)); },
        [&](std::size_t first, std::span<const std::byte> piece) {
            const auto* const values = reinterpret_cast<const Value*>(piece.data());
            if (!look(first, std::span(values, piece.size() / sizeof(Value)))) all = false;
            return all.load();
        });
    if (!done) return done.error();
    if (!all) scanner_.seek(before);
    return all.load();
}

} // namespace isotet::io
