// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Every file that HDF5, CGNS and the readers open passes here: the program's own open() stands before the C library's.
#pragma once

#include <string>
#include <vector>

namespace isotet::io::confined {

/// From here on only plain files and folders are opened (a pipe would wait for ever, a device can do something), and
/// what is opened is listed.
void watch_opened_files();

/// The files that were opened since the last call, absolute, each once.
std::vector<std::string> take_opened_files();

} // namespace isotet::io::confined
