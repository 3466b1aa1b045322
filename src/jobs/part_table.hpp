// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Connected parts of surfaces: which are kept, and a table of them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <isotet/jobs/extract_files.hpp>

namespace isotet::jobs {

/// Numbers of the parts that are kept, ascending; all without a choice.
///
/// `touched`   of PartChoice::Kind::touching; nothing: the grid's boundary, where isosurfaces are open
/// Errors      as parts_touching()
Result<std::vector<std::uint64_t>> kept_parts(const Surface& surface, const SurfaceParts& found,
                                              const std::optional<PartChoice>& choice,
                                              const std::optional<Region>& touched);

/// The solid's numbers, of its surface after parts or triangles were left out.
Result<void> measure_again(const Surface& surface, SolidNumbers& solid, const Run& run);

/// Notes which of the parts that are not kept are cavities.
void note_cavities(const SurfaceParts& found, const std::vector<std::uint64_t>& kept, Caller& caller);

/// A row for each part of each surface, kept or not, with a line of names first; numbers as they read back.
std::string parts_csv(const ExtractNumbers& numbers);

} // namespace isotet::jobs
