// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

namespace isotet::io::confined {

/// Who is told how far the reading of a file is, 0 to 1. One for the process, which reads one file at a time.
void on_progress(std::function<void(double)> listener);
void report_progress(double fraction);

} // namespace isotet::io::confined
