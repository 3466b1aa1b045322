// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "base/system/cache_folder.hpp"

#include <cstdlib>

namespace isotet::core {

namespace fs = std::filesystem;

fs::path cache_folder() {
    // As the XDG specification has it, relative paths do not count.
    if (const char* cache = std::getenv("XDG_CACHE_HOME"); cache && *cache == '/') return fs::path(cache) / "isotet";
    if (const char* home = std::getenv("HOME"); home && *home == '/') return fs::path(home) / ".cache" / "isotet";
    return {};
}

} // namespace isotet::core
