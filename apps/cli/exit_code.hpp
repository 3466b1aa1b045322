// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The exit status of the program: who has to act.
#pragma once

#include <utility>

#include <fmt/format.h>

#include <isotet/result.hpp>

namespace isotet::cli {

enum class ExitCode : int {
    done = 0,
    check_failed = 1, ///< `check` found what the rule asked for does not allow
    usage = 2,
    data = 3,    ///< a file, or what is in it
    machine = 4, ///< memory, disk, device
    fault = 5,   ///< of isotet
    interrupted = 130,
};

/// The error for an option or a name that is wrong.
template <class... Values>
Error usage_error(fmt::format_string<Values...> sentence, Values&&... values) {
    return {ErrorCode::invalid_argument, fmt::format(sentence, std::forward<Values>(values)...)};
}

inline ExitCode exit_code_of(ErrorCode code) noexcept {
    switch (code) {
    case ErrorCode::invalid_argument: return ExitCode::usage;
    case ErrorCode::invalid_data:
    case ErrorCode::file: return ExitCode::data;
    case ErrorCode::out_of_memory:
    case ErrorCode::cannot_write:
    case ErrorCode::no_device:
    case ErrorCode::device_failed:
    case ErrorCode::system: return ExitCode::machine;
    case ErrorCode::cancelled: return ExitCode::interrupted;
    case ErrorCode::internal: break;
    }
    return ExitCode::fault;
}

} // namespace isotet::cli
