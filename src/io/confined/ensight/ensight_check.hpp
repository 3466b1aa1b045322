// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Is all there that the files of an EnSight case promise? Where it is not, VTK's reader fills in zeros, drops cells, or does
// not end.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <isotet/result.hpp>

#include "io/confined/ensight/ensight_case.hpp"
#include "io/confined/ensight/ensight_file.hpp"

namespace isotet::io::confined {

/// What of a case is read at a step.
struct EnsightFound {
    struct Variable {
        std::vector<EnsightPlace> places; ///< of its files; none: there are no values at this time
        std::string problem;              ///< why it cannot be read; empty: it can
    };
    EnsightForm form = EnsightForm::ascii;
    bool is_big_endian = false; ///< of EnSight 6 as C binary: VTK's reader guesses it by the first count, wrongly for 64
    EnsightPlace model;
    std::vector<Variable> variables; ///< as those of the case
};

/// Walks through the geometry and the variables of one step, of EnSight Gold and 6, in all their forms: every count is
/// compared with what is left of the file, and every variable has as many values as the geometry has nodes or elements. What
/// VTK's reader is known to read wrong is a problem, too. Names of files in what is found are complete paths.
///
/// `step`     its number, from 0
/// `wanted`   for each variable of the case: others are not looked at
///
/// Errors   invalid_data, of the geometry: the file, what it should have, and where it ends; file: it is not there
/// Cost     binary files: a look at each part, and at each element where nodes of EnSight 6 have numbers; ascii files:
///          reading them once more
Result<EnsightFound> check_ensight(const std::string& case_file, const EnsightCase& found, std::size_t step,
                                   const std::vector<bool>& wanted);

/// The case that a file holds.
///
/// Errors   invalid_data: a line that stands where it may not, no geometry
Result<EnsightCase> read_case(const std::string& case_file);

} // namespace isotet::io::confined
