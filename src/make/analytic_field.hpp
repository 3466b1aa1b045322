// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The fields that make_grid() knows, as functions of the position or of the point's number.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "make/lattice.hpp"

namespace isotet::make {

struct AnalyticField {
    std::string_view name;
    float (*at)(const Position& position); ///< null for "integer", which depends on the point's number
};

extern const std::array<AnalyticField, 6> analytic_fields;

/// 0 to 4, drawn for each lattice point or centre.
std::int32_t small_integer(std::uint64_t seed, std::uint64_t point) noexcept;

} // namespace isotet::make
