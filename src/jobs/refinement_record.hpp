// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// How curved cells were refined for a surface, as field data of its file: its edge ends mean nothing without.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include <isotet/array.hpp>
#include <isotet/linear_cells.hpp>

namespace isotet::jobs {

inline constexpr std::string_view refinement_record_name = "isotet:refinement";

/// Tolerance, relative tolerance, geometry tolerance and distance, then the isovalues.
Field refinement_record(const RefineOptions& options);

/// Nothing where a file has no such record.
std::optional<RefineOptions> find_refinement_record(const std::vector<Field>& field_data);

} // namespace isotet::jobs
