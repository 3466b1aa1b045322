// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What a job says where memory ran out.
#pragma once

#include <string_view>

#include <isotet/result.hpp>

#include "base/guard.hpp"

namespace isotet::jobs {

/// An error of lack of memory with how much was missing, and `way`, which needs less, unless it names another. Other
/// errors as they are.
Error with_way_out(Error error, std::string_view way);

/// Calls `work`, which returns a Result. What it throws becomes an error: "WHAT ran out of memory".
template <class Work>
auto with_way_out(std::string_view what, std::string_view way, const Work& work) -> decltype(work()) {
    auto result = core::guarded(what, work);
    if (!result) return with_way_out(result.error(), way);
    return result;
}

} // namespace isotet::jobs
