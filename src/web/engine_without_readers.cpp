// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// isotet_engine.wasm: packed files and arrays only. isotet.js takes the other module for all other files.
#include "engine_files.hpp"

namespace isotet::web {

Result<ReadResult> read_grid_file(const std::string& path, const ReadOptions&, const Run&) {
    return Error{ErrorCode::invalid_argument,
                 path + " is no packed file: isotet_engine_readers.wasm reads others, and useModule() was given "
                        "isotet_engine.wasm"};
}

} // namespace isotet::web
