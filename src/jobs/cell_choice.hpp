// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Cells that a grid is restricted to, by the values of a cell field.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <isotet/grid.hpp>
#include <isotet/read.hpp>
#include <isotet/result.hpp>

namespace isotet::jobs {

/// "FIELD=LIST", or "!FIELD=LIST" for all other cells; LIST is of numbers, ranges A:B and names of regions.
struct CellChoice {
    std::string text; ///< as the option has it
    bool others = false;
    std::string field;
    std::string list;
};

/// `fields`   names of the cell fields that there are
Result<std::vector<CellChoice>> parse_cell_choices(const std::vector<std::string>& texts,
                                                   const std::vector<std::string>& fields);

/// An item of the list is no number, no range and no name of the field's regions.
Result<void> check_cell_choices(std::span<const CellChoice> choices, const std::vector<RegionName>& regions);

/// For readers.
/// Errors   as check_cell_choices()
Result<std::vector<CellCondition>> conditions_of(std::span<const CellChoice> choices,
                                                 const std::vector<RegionName>& regions);

struct ChosenCells {
    Grid grid; ///< other cells have VTK's type 0, so that all keep their numbers; points that they alone use
               ///< have no value, of integers they keep it
    std::size_t count = 0;            ///< all choices hold for them
    std::size_t of = 0;               ///< cells among which was chosen
    std::vector<std::string> missing; ///< sentences about numbers and ranges that no cell has
};

/// Where cells with a volume are left, it is chosen among these: flat ones and others without a volume stay as they are.
///
/// Errors   invalid_argument: a field that the grid does not have or that has several components, a name that is no
///          region's, or no cell is left
Result<ChosenCells> choose_cells(Grid grid, std::span<const CellChoice> choices,
                                 const std::vector<RegionName>& regions);

/// "region=1,2 and !material=3".
std::string text_of(std::span<const CellChoice> choices);

} // namespace isotet::jobs
