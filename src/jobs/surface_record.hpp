// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What the edge ends of a surface refer to, as field data of its file: how curved cells were refined, and the time step.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include <isotet/array.hpp>
#include <isotet/linear_cells.hpp>

namespace isotet::jobs {

inline constexpr std::string_view refinement_record_name = "isotet:refinement";

inline constexpr std::string_view time_record_name = "isotet:time";

/// Tolerance, relative tolerance, geometry tolerance and distance, then the isovalues.
Field refinement_record(const RefineOptions& options);

/// Nothing where a file has no such record.
std::optional<RefineOptions> find_refinement_record(const std::vector<Field>& field_data);

/// Of a grid with several time steps.
struct SurfaceTime {
    double time = 0; ///< between two steps: of none of them
    std::size_t step = 0;
};
Field time_record(const SurfaceTime& time);
std::optional<SurfaceTime> find_time_record(const std::vector<Field>& field_data);

} // namespace isotet::jobs
