// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <isotet/result.hpp>

namespace isotet::io::confined {

struct ExodusParts {
    std::vector<std::string> files;
    std::vector<std::string> missing; ///< of a file that is there alone, although its name counts others
};

/// All files of a grid in parts: of "run.e.4.1" the files "run.e.4.0" to "run.e.4.3"; of any other name the one file.
/// Numbers may have leading zeros ("run.e.16.03"). A file alone under such a name is one file.
///
/// Errors   file when some other parts are there and others are not
Result<ExodusParts> exodus_parts(const std::string& path);

} // namespace isotet::io::confined
