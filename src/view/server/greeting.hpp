// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What a page is told first: who is there, and what there is to look at.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <isotet/first_view.hpp>
#include <isotet/grid.hpp>
#include <isotet/packed_file.hpp>
#include <isotet/read.hpp>

#include "view/grid_view.hpp"
#include "view/json.hpp"
#include "view/state.hpp"

namespace isotet::view {

/// What a page can look at, once it is read.
struct ViewerInput {
    Grid grid;
    ViewState state; ///< to begin with; no isovalues: Chart::first
    std::vector<std::string> notes;
    std::vector<double> times;             ///< of the file's steps; fewer than two: it has one
    std::optional<PackedFile> packed = {}; ///< where the grid lies, packed; then `grid` has some of its `cells`
    std::uint64_t cells = 0;
    std::vector<RegionName> regions = {}; ///< of numbers that colour
};

/// What is shown first of a grid of which no field is named: the boundary stands alone where `draw` says so.
void take_first_view(const FirstView& first, ViewState& state);

/// {"say": "welcome", ...}: 64 colours of each map among it.
/// `out`     the folder where pages may save files; empty: none
/// `other`   the file that is shown beside it; empty: none
Json welcome_json(const std::string& file, const std::string& version, const std::string& out,
                  const std::string& other = {});

/// {"say": "grid", ...}. Of `input` all but the grid, which is in `view`.
Json grid_json(const GridView& view, const std::string& file, const ViewerInput& input);

} // namespace isotet::view
