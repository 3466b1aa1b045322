// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Sentences of the library in the words of the page.
#pragma once

#include <string>
#include <string_view>

namespace isotet::view {

/// Options in backquotes (`merge_points`) become the page's control, such as Field, or else "isotet view --merge-points" where view has
/// such an option. All other words stay, and what is 'quoted'.
std::string page_words(std::string_view sentence);

} // namespace isotet::view
