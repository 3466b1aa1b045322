// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What the user should know of extracted surfaces.
#pragma once

#include <span>
#include <string>

#include <isotet/jobs/extract_files.hpp>

namespace isotet::jobs {

/// Whose values FillValues of a field are: "point" or "cell".
const char* fill_is_of(const PointField& field);
/// That some numbers stand for no value, and what leaves out their cells; empty where none does.
/// `of`   "point" or "cell", whose values they are
std::string fill_note(const std::string& field, const FillValues& fill, const char* of);

/// Why an isovalue gives no surface: a sentence.
std::string why_empty(const FieldReport& field, double isovalue);

/// The same where all isovalues are outside the range of the field, at least one of them beyond it, so that they were not
/// meant; empty where some are inside, or no value is finite. `decimal_comma` as of ExtractJob.
std::string why_all_are_empty(const FieldReport& field, std::span<const double> isovalues,
                              std::optional<double> decimal_comma);

/// The same of a solid.
std::string why_solid_is_empty(const FieldReport& field, const SolidRange& range);

/// Notes of one surface: that it is empty, ties that only rounding made.
void note_what_extracting_found(const ExtractNumbers& numbers, const SurfaceNumbers& surface, Caller& caller);

/// The same of one solid: that it is empty or open.
void note_what_a_solid_is(const ExtractNumbers& numbers, const SurfaceNumbers& surface, Caller& caller);

/// Notes of a step: what was left out, and what rounding did.
void note_what_the_step_holds(const ExtractNumbers& numbers, const Grid& grid, std::uint64_t coarse_tets,
                              Caller& caller);

} // namespace isotet::jobs
