// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What is written in a picture, and said of it.
#pragma once

#include <isotet/render.hpp>
#include <isotet/jobs/draw_files.hpp>

namespace isotet::jobs {

/// Scale, legend and caption; empty with `plain`.
Annotation annotation_of(const DrawJob& job, const DrawInput& input);

/// Notes the isovalues that give no surface, and slices that do not meet the grid.
void note_what_is_empty(const DrawJob& job, const DrawInput& input, Caller& caller);

} // namespace isotet::jobs
