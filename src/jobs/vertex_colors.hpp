// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Colours by a field, as numbers that go into files.
#pragma once

#include <vector>

#include <isotet/scene.hpp>
#include <isotet/jobs/extract_files.hpp>
#include <isotet/jobs/job.hpp>
#include <isotet/result.hpp>
#include <isotet/surface.hpp>

namespace isotet::jobs {

/// The scale that is asked for; `range` is empty, or has both ends.
Result<ColorOptions> color_options(const ColorScale& scale, const std::vector<double>& range);

/// Adds the point field "rgb" (uint8, 3 components): the colours of the field that `colors` names.
///
/// Errors   invalid_argument: the surface has no such point field, or a wrong range
Result<void> add_vertex_colors(Surface& surface, const ColorChoice& colors, Caller& caller);

} // namespace isotet::jobs
