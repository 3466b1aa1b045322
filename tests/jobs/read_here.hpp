// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <string>

#include <isotet/read.hpp>

namespace isotet::test {

/// Whether grids in files of this ending are read: those of isotet-reader only where it was built.
inline bool is_read_here(const std::string& path) {
    const std::string ending = path.substr(path.rfind('.'));
    return std::ranges::any_of(formats(), [&](const Format& format) {
        return format.reads_grid && std::ranges::find(format.extensions, ending) != format.extensions.end();
    });
}

} // namespace isotet::test
