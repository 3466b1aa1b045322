// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Values that are in no chunk of an HDF5 file, and that HDF5 was told not to fill in: reading leaves memory as it was.
#pragma once

#include <cstddef>
#include <span>

#include <hdf5.h>

namespace isotet::io::confined {

/// False where all values are stored, or those that are not have a value that the file states.
bool may_be_unwritten(hid_t data);

enum class HdfRead { done, failed, unwritten };

/// H5Dread into `to`. Where values may be unwritten the memory is filled in two ways before, and what differs
/// afterwards was not read.
HdfRead read_written(hid_t data, hid_t type, hid_t memory, hid_t space, std::span<std::byte> to);

} // namespace isotet::io::confined
