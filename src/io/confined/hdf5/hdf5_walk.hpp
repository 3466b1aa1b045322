// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <isotet/read.hpp>
#include <isotet/result.hpp>

namespace isotet::io::confined {

/// Goes over the names in an HDF5 file, without their data, before anybody reads it: links and data in other files must
/// be files that the index rules allow (check_name(), named_file()), which are gone over, too; no group may contain
/// itself; virtual data sets must be whole (check_virtual_data()). Files of other kinds pass.
///
/// Returns  what HDF5 cannot open, or links to nothing, and a grid can lack: arrays of VTKHDF, fields of MED, solutions of
///          CGNS, variables of Exodus
///
/// Cost     O(objects), at most a million
/// Errors   invalid_data: the name that breaks a rule; the file, a group or another object cannot be opened; the file is
///          shorter than it says
Result<std::vector<LeftOut>> check_hdf5_names(const std::string& path, bool allow_outside);

} // namespace isotet::io::confined
