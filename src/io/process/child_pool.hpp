// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Reader processes that wait for another request, so that a series of steps starts one process.
#pragma once

#include <memory>
#include <string>

#include "io/process/child_process.hpp"

namespace isotet::io::confined {

/// A process that has answered before, and was started by the same key; null where there is none.
std::unique_ptr<ReaderChild> take_idle_child(const std::string& key);

/// Keeps a process for later. It ends by itself ten seconds after its last request, with this program, or when more
/// than a few wait.
void keep_idle_child(std::string key, std::unique_ptr<ReaderChild> child);

} // namespace isotet::io::confined
