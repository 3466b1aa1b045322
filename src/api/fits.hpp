// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Whether what is asked for can be had from a packed grid.
#pragma once

#include <isotet/export.hpp>
#include <isotet/extract.hpp>

#include "packed/packed.hpp"

namespace isotet::api {

/// Errors   invalid_argument when something was not packed, or a field has another length
ISOTET_API Result<void> check_fit(const ExtractOptions& options, const core::Packed& packed);

} // namespace isotet::api
