// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The errors that are made most.
#pragma once

#include <string>
#include <string_view>
#include <utility>

#include <isotet/result.hpp>

namespace isotet {

inline Error invalid_argument(std::string message) { return {ErrorCode::invalid_argument, std::move(message)}; }
inline Error invalid_data(std::string message) { return {ErrorCode::invalid_data, std::move(message)}; }

/// Of an object that was moved from, and then asked for something.
inline Error moved_from(std::string_view what) {
    return invalid_argument(std::string(what) + " was moved to another object and is empty");
}

} // namespace isotet
