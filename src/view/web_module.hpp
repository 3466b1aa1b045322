// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// isotet as WebAssembly, where the build was given it (ISOTET_WEB_MODULE).
#pragma once

#include <string_view>

namespace isotet::view {

/// The module; empty where there is none.
std::string_view web_module();

} // namespace isotet::view
