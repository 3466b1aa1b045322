// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The two errors that are made most, from their sentences.
#pragma once

#include <string>
#include <utility>

#include <isotet/result.hpp>

namespace isotet {

inline Error invalid_argument(std::string message) { return {ErrorCode::invalid_argument, std::move(message)}; }
inline Error invalid_data(std::string message) { return {ErrorCode::invalid_data, std::move(message)}; }

} // namespace isotet
