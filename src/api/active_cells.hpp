// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <isotet/extract_direct.hpp>

namespace isotet::api {

/// Errors   invalid_argument: an extraction with these options needs cells that isovalues do not cut
Result<void> check_active_cells_do(const DirectOptions& options);

} // namespace isotet::api
