// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// From a frame to how a piece is stored: the choices that packing makes from the values of a whole grid.
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include <isotet/frame.hpp>
#include <isotet/pack.hpp>

#include "numbers/storage.hpp"
#include "packed/packed.hpp"

namespace isotet::core {

/// What FieldSurvey::name holds.
std::uint64_t name_in_survey(std::string_view name);

/// As choose_offset() and choose_scale() have it from the values of all pieces; but where there is an offset, only a
/// bound on the smallest difference from it is known, so the scale may be another: that moves no vertex.
Storage storage_in(const FieldSurvey& field, Precision precision);

/// The centre of the points, rounded to float32.
std::array<double, 3> origin_in(const Survey& whole);

/// Whether most tetrahedra of the whole grid are negative.
inline bool is_mostly_negative(const Frame& frame) { return frame.whole.upright < 0; }

/// What the frame knows of a field; null without a frame.
/// Errors   invalid_argument when it does not know the field, or has it of another type
Result<const FieldSurvey*> find_in_frame(const std::optional<Frame>& frame, std::string_view name, ScalarType type);

/// Errors   invalid_argument when a value is outside of what the frame has
Result<void> check_range(const FieldSurvey& framed, std::string_view name, const ValueStatistics& statistics);

/// Errors   invalid_argument when points are of another type than those of the frame, or outside of its bounds
Result<void> check_point_type(const Frame& frame, ScalarType type);
Result<void> check_bounds(const Frame& frame, const std::array<double, 3>& lower, const std::array<double, 3>& upper);

} // namespace isotet::core
