// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Fields that are colours: three or four numbers of a byte, in sRGB.
#pragma once

#include <array>

#include "io/write/write_stream.hpp"

namespace isotet::io {

inline bool is_color(const Column& field) {
    return field.type == ScalarType::uint8 && (field.components == 3 || field.components == 4);
}

/// Light, from 0 to 1, of each of the 256 steps of sRGB.
std::array<double, 256> light_of_bytes();

} // namespace isotet::io
