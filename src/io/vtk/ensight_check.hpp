// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Is all there that the files of an EnSight case promise? Where it is not, VTK's reader fills in zeros, drops cells, or does
// not end.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include <isotet/result.hpp>

namespace isotet::io::vtk {

/// What VTK's reader has to be told of EnSight 6 as C binary: it guesses the byte order by the first count, wrongly for 64.
struct EnsightBinary6 {
    bool is_big_endian = false;
};

/// Walks through the geometry and the variables of one step, of EnSight Gold and 6, in all their forms: every count is
/// compared with what is left of the file, and every variable has as many values as the geometry has nodes or elements. What
/// VTK's reader is known to read wrong is an error, too.
///
/// `step`   its number, from 0
///
/// Not looked at: measured points, which are no grid, and files that are not there, which VTK's reader tells.
///
/// Returns  nothing for all but C binary files of EnSight 6
/// Errors   invalid_data: the file, what it should have, and where it ends
/// Cost     binary files: a look at each part, and at each element where nodes of EnSight 6 have numbers; ascii files:
///          reading them once more
Result<std::optional<EnsightBinary6>> check_ensight(const std::string& case_file, std::size_t step);

} // namespace isotet::io::vtk
