// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What a module for pages has once: the text that JavaScript gives, and the grid that is looked at.
#pragma once

#include <memory>
#include <string>

#include "looker.hpp"

namespace isotet::web {

inline std::string room;               ///< of the text
inline std::unique_ptr<Looker> looker; ///< null: nothing is open

/// Opens a packed grid, and tells the page; a sentence where it cannot be.
///
/// `path`   as the page's file system has it
void open_packed(const std::string& path, const Told& told);

} // namespace isotet::web
