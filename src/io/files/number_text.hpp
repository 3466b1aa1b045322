// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Many numbers of a text at once, on all threads.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#include <isotet/array.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>

#include "io/files/byte_source.hpp"

namespace isotet::io {

/// Reads `count` numbers that begin in [begin, end) of the source, by the rules of TextScanner and read_scalar().
///
/// `what`    for the message: "the array 'p'"
/// `to`      room for `count` scalars of the type; null: they are only checked
/// Returns   where the text goes on behind the last of them
/// Errors    invalid_data: a word among them is no number of the type or longer than 512 characters, or there are fewer
///           (before memory is taken: a number takes a character and a space); as ByteSource::read(); cancelled
/// Cost      parallel; transient memory at most 40 MB
Result<std::size_t> read_numbers(const ByteSource& source, std::size_t begin, std::size_t end, ScalarType type,
                                 std::uint64_t count, std::string_view what, std::byte* to, const Progress& progress);

/// An error where so short a text cannot hold so many numbers.
Result<void> check_room(std::size_t begin, std::size_t end, std::uint64_t count, std::string_view what);

} // namespace isotet::io
