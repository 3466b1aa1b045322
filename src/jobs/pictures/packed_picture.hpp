// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Pictures of packed files that are drawn without their grids.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include <isotet/scene.hpp>
#include <isotet/jobs/draw_files.hpp>
#include <isotet/packed_file.hpp>

namespace isotet::jobs {

/// Whether a picture needs the cells themselves: else surfaces come from the chunks that isovalues meet.
bool needs_cells(const DrawJob& job);

/// What is noted before all of a file is unpacked.
std::string note_of_unpacking(const PackedFileInfo& file);

/// A field that can be contoured and coloured by as it is packed; null where there is none of this name at a step.
const PackedFieldInfo* packed_field(const PackedFileInfo& file, std::string_view name, std::size_t step,
                                    bool with_gradients);

/// What find_colors() gives for a field in place of which only its report is known: `values` are the ends of its range, and NaN
/// where some points have no data.
Result<FoundColors> colors_of_report(const FieldReport& report, const ColorOptions& options, const Run& run);

} // namespace isotet::jobs
