// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// isotet_engine_readers.wasm: reads files of all formats.
#include "engine_files.hpp"

namespace isotet::web {

Result<ReadResult> read_grid_file(const std::string& path, const ReadOptions& options, const Run& run) {
    return isotet::read(path, options, run);
}

} // namespace isotet::web
