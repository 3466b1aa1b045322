// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Medit's .sol and .solb files: values at vertices, and in cells of each kind.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include <isotet/progress.hpp>
#include <isotet/read.hpp>
#include <isotet/result.hpp>

namespace isotet::io::medit {

struct SolutionField {
    FieldInfo info;
    bool wanted = false;
    Array values;
};

/// SolAtVertices, SolAtTetrahedra and so on.
struct SolutionSection {
    std::int32_t keyword = 0;
    std::uint64_t count = 0;
    std::vector<SolutionField> fields;
};

struct Solution {
    std::vector<SolutionSection> sections;
    std::vector<LeftOut> left_out; ///< sections of other things, and what is broken
    bool whole = true;             ///< it ended with End
};

/// `options`   null: only the kinds of fields are read
/// Errors      cancelled
Result<Solution> read_solution(std::string_view bytes, const ReadOptions* options, const Progress& progress);

/// Cells of one kind that follow one another.
struct CellRun {
    std::int32_t keyword = 0;
    std::uint64_t first = 0, count = 0;
};

/// Puts wanted values into the grid, at the cells they belong to. What does not fit is left out.
void give_solution(Solution solution, std::span<const CellRun> runs, ReadResult& result);

} // namespace isotet::io::medit
