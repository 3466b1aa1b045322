// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Isosurfaces of a grid in a page of one file, among which a slider goes.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <isotet/progress.hpp>
#include <isotet/result.hpp>

#include "view/server/greeting.hpp"
#include "view/steps.hpp"

namespace isotet::view {

struct SavedSurfacesOptions {
    std::string file;              ///< the name that the page shows
    std::string version;           ///< of isotet
    std::vector<double> isovalues; ///< these; empty: `count` of them
    std::size_t count = 63; ///< evenly inside the range: lower + k (upper - lower) / (count + 1), as short decimals
    std::optional<ValueRange> range; ///< nothing: of the field, at the steps that are shown
    std::vector<std::size_t> steps;  ///< of the file, rising; at least one
    std::uint64_t max_bytes = 20'000'000;
    std::size_t max_triangles = 8'000'000;                 ///< of a surface; larger ones are simplified
    std::optional<RefineOptions> refine = RefineOptions{}; ///< of curved cells; nothing: they are split at their nodes
};

/// What became of it.
struct SavedSurfaces {
    std::string html;
    std::vector<double> isovalues;  ///< that are there, rising
    std::size_t left_out = 0;       ///< of those that were asked for, as the file would be too large
    std::uint64_t triangles = 0;    ///< of all surfaces
    std::vector<std::string> notes; ///< what was left out or simplified
    bool boundary = false;
    std::uint64_t data_bytes = 0; ///< of the file: surfaces and boundary
};

/// Extracts the isosurfaces of a state and makes the page of them. Where it would be larger than `max_bytes`, of
/// `count` surfaces as many are left out as it takes, evenly: every second, third and so on stays; the boundary goes
/// first where it alone takes a quarter. A state without isosurfaces begins with the boundary, which may then take three
/// quarters.
///
/// `input`      whose state says field, colours, camera and what else is shown at the beginning
/// `read_step`  of any step; may be empty for one step
/// Guarantees   the same bytes for the same grid and options
/// Errors       as GridView::create() and GridView::frame(); invalid_argument: isovalues that were named, or a single
///              surface, do not fit; no isovalue where the field has no range
Result<SavedSurfaces> save_surfaces(ViewerInput input, const ReadStep& read_step, const SavedSurfacesOptions& options,
                                    const Run& run = {});

} // namespace isotet::view
