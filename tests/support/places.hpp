// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Where the tests find the source tree and the program. Written by the build into one source file (tests/CMakeLists.txt),
// so that the other tests compile to the same bytes in every folder.
#pragma once

#include <filesystem>
#include <string>

namespace isotet::test {

std::filesystem::path source_folder();

/// Path of the program isotet; empty when it is not built.
std::string program_path();

/// Path of the program isotet-reader; empty when it is not built.
std::string reader_path();

} // namespace isotet::test
