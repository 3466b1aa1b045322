// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <isotet/progress.hpp>
#include <isotet/result.hpp>

#include "io/files/byte_source.hpp"

namespace isotet::io {

/// Some of the tuples that lie one after another from byte `begin` on, each of `bytes` bytes. Those near one another are
/// read together.
///
/// `tuples`   numbers, ascending;  `to`   room for as many
/// Errors     as ByteSource::read(); cancelled
/// Cost       parallel; a thread takes 256 KB, or a tuple
Result<void> read_tuples(const ByteSource& source, std::size_t begin, std::size_t bytes,
                         std::span<const std::uint64_t> tuples, std::byte* to, const Progress& progress);

} // namespace isotet::io
