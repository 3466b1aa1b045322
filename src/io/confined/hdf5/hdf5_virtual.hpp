// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Virtual data sets of HDF5: put together of data sets in other files, as VTK writes partitions and time steps.
#pragma once

#include <string>
#include <vector>

#include <hdf5.h>

#include <isotet/result.hpp>

namespace isotet::io::confined {

/// The other files of a virtual data set, by the names that it has for them, each once.
///
/// Errors   invalid_data: names that cannot be read, or have numbers put in
Result<std::vector<std::string>> files_of_virtual_data(hid_t data);

/// Opens what a data set of `file` is put together of: where something is missing HDF5 would give fill values. It must be
/// whole rows, one after another, of data sets that are not virtual themselves.
///
/// `may_lack_rows`   some may be those of nothing: VTK has them for the offsets of empty partitions
/// Errors   invalid_data: what is missing or put together otherwise, as the end of a sentence about the data set
Result<void> check_virtual_data(hid_t data, const std::string& file, bool allow_outside,
                                bool may_lack_rows);

} // namespace isotet::io::confined
