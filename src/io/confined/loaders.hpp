// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The formats, one function each. They run in the reader process only.
#pragma once

#include "io/pieces/loaded.hpp"

namespace isotet::io::confined {

/// One format, in the reader process.
using Load = Result<Loaded> (*)(const std::string& path, const ReadOptions& options, Depth depth);

/// The loader of a format, or null.
Load loader_of(std::string_view format);

/// Lets go of the HDF5 files that loaders opened, once for several uses: those that nothing else holds are closed.
void close_hdf5_files();

Result<Loaded> load_exodus(const std::string& path, const ReadOptions& options, Depth depth);
Result<Loaded> load_cgns(const std::string& path, const ReadOptions& options, Depth depth);
Result<Loaded> load_med(const std::string& path, const ReadOptions& options, Depth depth);
Result<Loaded> load_vtkhdf(const std::string& path, const ReadOptions& options, Depth depth);
Result<Loaded> load_ensight(const std::string& path, const ReadOptions& options, Depth depth);
Result<Loaded> load_xdmf(const std::string& path, const ReadOptions& options, Depth depth);

} // namespace isotet::io::confined
