// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "jobs/way_out.hpp"

#include <string>

#include "base/system/fresh_memory.hpp"

namespace isotet::jobs {

Error with_way_out(Error error, std::string_view way) {
    if (error.code != ErrorCode::out_of_memory) return error;
    constexpr std::string_view without_amounts = " ran out of memory";
    std::string& message = error.message;
    if (message.ends_with(without_amounts))
        message = core::ran_out_of_memory(message.substr(0, message.size() - without_amounts.size())).message;
    if (message.find("; ") == std::string::npos) message.append("; ").append(way).append(" needs less");
    return error;
}

} // namespace isotet::jobs
