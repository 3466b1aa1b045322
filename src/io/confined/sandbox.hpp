// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What the reader process may still do once it looks at a file.
#pragma once

#include <span>
#include <string>

namespace isotet::io::confined {

/// For this thread and those that it starts, for good: no new privileges; files can be opened for reading only, and only
/// below `readable` (folders or files; Landlock); no network, no other programs or processes, no file made, changed,
/// renamed or removed, no code from files (seccomp). What the system lacks is left out: reader_confinement() tells.
void confine(std::span<const std::string> readable);

} // namespace isotet::io::confined
