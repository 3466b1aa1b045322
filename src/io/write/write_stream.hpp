// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// How the writers write: columns of scalars and rows of text through one core::OutputFile, with progress and cancel.
#pragma once

#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include <isotet/array.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>
#include <isotet/write.hpp>

#include "base/system/output_file.hpp"

namespace isotet::io {

/// Scalars as a file shall hold them: made in pieces, so that no whole copy ever exists.
struct Column {
    std::string name;
    ScalarType type = ScalarType::float32;
    std::size_t tuples = 0;
    std::size_t components = 1;
    /// Puts tuples [begin, end) at `out`, in the machine's byte order.
    std::function<void(std::size_t begin, std::size_t end, std::byte* out)> fill;

    std::size_t tuple_bytes() const noexcept { return components * size_of(type); }
    std::uint64_t bytes() const noexcept { return static_cast<std::uint64_t>(tuples) * tuple_bytes(); }
};

/// Appends the text or bytes of rows [begin, end).
using RowWriter = std::function<void(std::size_t begin, std::size_t end, std::string& out)>;

/// Remembers the first error and then does nothing more, so that a writer can be a list of what it writes.
class WriteStream {
public:
    /// `expected` bytes, for progress; about right is enough.
    WriteStream(core::OutputFile& file, const Progress& progress, std::uint64_t expected)
        : file_(file), progress_(progress), expected_(expected) {}

    void text(std::string_view text);
    void column(const Column& column, std::endian order);
    /// Rows are made in parallel and written in order.
    void rows(std::size_t count, const RowWriter& writer);

    template <std::unsigned_integral T>
    void number(T value, std::endian order) {
        if (order != std::endian::native) value = swapped(value);
        text({reinterpret_cast<const char*>(&value), sizeof value});
    }

    /// The first error, or success.
    Result<void> finish() const;
    const Progress& progress() const noexcept { return progress_; }

private:
    template <std::unsigned_integral T>
    static T swapped(T value) noexcept {
        T result = 0;
        for (std::size_t i = 0; i < sizeof value; ++i, value = static_cast<T>(value >> 8U)) {
            result = static_cast<T>((result << 8U) | (value & 0xFFU));
        }
        return result;
    }
    bool goes_on();

    core::OutputFile& file_;
    const Progress& progress_;
    std::uint64_t expected_;
    std::optional<Error> error_;
};

/// Reverses the bytes of each of `count` scalars of `size` bytes.
void swap_bytes(std::byte* data, std::size_t count, std::size_t size) noexcept;

/// Opens `path`, lets `write` fill a stream, and commits the file if all went well.
Result<WriteReport> write_file(const std::string& path, const Progress& progress, std::uint64_t expected,
                               const std::function<void(WriteStream&)>& write);

} // namespace isotet::io
