// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <hdf5.h>

namespace isotet::io::confined {

/// Why H5Dread fails: what the data set is compressed with and this HDF5 does not have, and the way out; else that it cannot
/// be read.
std::string why_not_read(hid_t data);

} // namespace isotet::io::confined
