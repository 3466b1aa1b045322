// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// All bytes of a surface as one string, to compare surfaces bit for bit.
#pragma once

#include <string>

#include <isotet/surface.hpp>

#include "base/surface_arrays.hpp"

namespace isotet::test {

inline void append_bytes(std::string& out, const Array& array) {
    out += std::string(name_of(array.type())) + " " + std::to_string(array.tuples()) + "x" +
           std::to_string(array.components()) + ":";
    out.append(static_cast<const char*>(array.data()), array.bytes());
}

inline std::string bytes_of(const Surface& s) {
    std::string out;
    core::each_array(s, [&](const Array& array, SurfaceArray, std::string_view field) {
        out += field;
        append_bytes(out, array);
    });
    return out;
}

} // namespace isotet::test
