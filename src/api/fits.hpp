// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Whether what is asked for can be had from a packed grid.
#pragma once

#include <cstdint>

#include <isotet/extract.hpp>

#include "core/packed.hpp"

namespace isotet::api {

/// Errors   invalid_argument when something was not packed, or a field has another length
Result<void> check_fit(const ExtractOptions& options, const core::Packed& packed);

/// Its parts, for a packed grid that is gone.
Error no_gradients();
Result<void> check_length(const Field& point_field, std::uint64_t user_points);

} // namespace isotet::api
