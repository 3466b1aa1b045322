// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Is all there that a file's header promises? Libraries fill in zeros, or stop early, where it is not.
#pragma once

#include <string>

#include <isotet/result.hpp>

#include "io/files/byte_source.hpp"

namespace isotet::io::confined {

/// HDF5: the end of file that the superblock states is there. Other files pass.
Result<void> check_hdf5_length(const ByteSource& file, const std::string& path);

/// ADF (CGNS): the end of file that the header states is there. Other files pass.
Result<void> check_adf_length(const std::string& path);

} // namespace isotet::io::confined
