// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// HDF5 files, opened once a request.
#pragma once

#include <memory>
#include <mutex>
#include <string>

#include <isotet/result.hpp>

#include "io/confined/hdf5/hdf5_handle.hpp"
#include "io/files/byte_source.hpp"

namespace isotet::io::confined {

/// Held for every call of HDF5 while others may read; no parallel work is begun under it.
std::recursive_mutex& hdf5_calls();

/// An open file: for HDF5, and its bytes.
struct Hdf5File {
    ByteSource source;
    Handle file;
};

/// Opens a file, or gives one that is open already: the last few are kept until close_hdf5_files() (loaders.hpp). Messages of HDF5 are
/// not printed from here on.
///
/// Errors    invalid_data: no HDF5 file, a broken one, or cut short; as ByteSource::open()
/// Threads   as HDF5: one call at a time
Result<std::shared_ptr<const Hdf5File>> open_hdf5(const std::string& path);

} // namespace isotet::io::confined
