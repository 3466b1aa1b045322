// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Which folder may include from which: the picture in docs/inside/architecture.md as a table.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace isotet::test {

/// The name between the quotes or angle brackets of an #include line; empty when the line is none.
std::string included_name(std::string_view line);

/// What the rules say against the file `path` (relative to the root of the tree) including `name`; empty when nothing.
std::string objection(std::string_view path, std::string_view name);

} // namespace isotet::test
