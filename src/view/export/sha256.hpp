// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// SHA-256 (FIPS 180-4), by which a page's policy names the script that it may run.
#pragma once

#include <string>
#include <string_view>

namespace isotet::view {

/// 32 bytes. Cost   O(n), a hundred MB a second: for scripts, not for data
std::string sha256(std::string_view bytes);

} // namespace isotet::view
