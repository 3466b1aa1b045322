// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Where things are kept that cost only time when they are lost.
#pragma once

#include <filesystem>

#include <isotet/export.hpp>

namespace isotet::core {

/// $XDG_CACHE_HOME/isotet, or ~/.cache/isotet; empty where neither is set. It need not exist.
ISOTET_API std::filesystem::path cache_folder();

} // namespace isotet::core
