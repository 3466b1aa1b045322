// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>

#include <isotet/progress.hpp>
#include <isotet/read.hpp>
#include <isotet/result.hpp>

#include "io/pieces/loaded.hpp"

namespace isotet::io::ucd {

/// The byte that a binary file begins with.
constexpr char binary_mark = '\x07';

/// Reads a binary UCD file of either byte order. Points and fields are float32.
///
/// Errors   invalid_data: a length that is not what the header says; cells of unknown types or with points that are not
///          there; arrays whose components do not add up
Result<ReadResult> read_binary(std::string_view bytes, const ReadOptions& options, const Progress& progress,
                               Depth depth);

} // namespace isotet::io::ucd
