// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace isotet::io::confined {

/// Answers what the program that started this one asks, until it ends or asks nothing for ten seconds; the exit status.
int serve();

} // namespace isotet::io::confined
