// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <utility>

#include <fmt/format.h>

#include <isotet/result.hpp>

namespace isotet::jobs {

/// The error for an option or a name that is wrong.
template <class... Values>
Error refusal(fmt::format_string<Values...> sentence, Values&&... values) {
    return {ErrorCode::invalid_argument, fmt::format(sentence, std::forward<Values>(values)...)};
}

} // namespace isotet::jobs
