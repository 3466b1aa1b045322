// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// isotet as WebAssembly, where the build was given it (ISOTET_WEB_MODULE).
#pragma once

#include <string_view>

namespace isotet::view {

/// The module that looks at a packed grid; empty where there is none.
std::string_view web_module();

/// The same with isotet's own readers.
std::string_view web_reader_module();

} // namespace isotet::view
