// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// A packed grid in a page of one file, or none yet, with isotet as WebAssembly, which looks at it.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <isotet/result.hpp>

#include "view/state.hpp"

namespace isotet::view {

struct SavedGridOptions {
    std::string file;               ///< the name that the page shows
    std::string version;            ///< of isotet
    ViewState state;                ///< to begin with; `field` is one of the file's
    std::vector<std::string> notes; ///< of the grid
};

/// Whether there can be such pages. Errors   invalid_argument: isotet was built without the module
Result<void> check_grid_pages();

/// The page. `packed`   the bytes of a packed file (packed_file.hpp), which is not looked into
/// Errors   as check_grid_pages(); out_of_memory
Result<std::string> grid_page(std::string_view packed, const SavedGridOptions& options);

/// The page that grid_page() fills: without a grid, and with the name "isotet" and nothing told of it. For Python, which puts
/// in what it packed.
/// Errors      as grid_page()
Result<std::string> unfilled_page();

/// A page without a grid, into which files are dropped that isotet's own readers read.
///
/// `version`   of isotet
/// Errors      as grid_page()
Result<std::string> empty_page(const std::string& version);

} // namespace isotet::view
