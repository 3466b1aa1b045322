// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The page: files of src/view/web/, which the build puts into the program.
#pragma once

#include <vector>

#include "view/server/server.hpp"

namespace isotet::view {

std::vector<ServedFile> page_files();

} // namespace isotet::view
