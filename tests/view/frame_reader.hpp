// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The head of a frame.
#pragma once

#include <cstring>
#include <stdexcept>
#include <string>

#include "view/json.hpp"

namespace isotet::test {

inline view::Json head_of(const std::string& frame) {
    std::uint32_t length = 0;
    if (frame.size() < 8 || frame.compare(0, 4, "isof") != 0) throw std::runtime_error("no frame");
    std::memcpy(&length, frame.data() + 4, 4);
    return view::Json::parse(frame.substr(8, length));
}

} // namespace isotet::test
