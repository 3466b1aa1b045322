// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Fields of packed grids for engines that carry the user's arrays only.
#pragma once

#include <isotet/export.hpp>
#include <isotet/extract.hpp>

namespace isotet::api {

/// The options with packed_fields as point_fields, in the same order.
/// Errors   as unpack_field()
ISOTET_API Result<ExtractOptions> with_unpacked_fields(ExtractOptions options, const Run& run);

} // namespace isotet::api
