// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Where things are kept that cost only time when they are lost.
#pragma once

#include <filesystem>

namespace isotet::core {

/// $XDG_CACHE_HOME/isotet, or ~/.cache/isotet; empty where neither is set. It need not exist.
std::filesystem::path cache_folder();

} // namespace isotet::core
