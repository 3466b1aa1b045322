// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What the name of a field says of it.
#pragma once

#include <cstdint>
#include <string_view>

namespace isotet::core {

enum class NameKind : std::uint8_t {
    quantity,   ///< something that people contour
    plain,      ///< says nothing
    region,     ///< numbers parts of the grid, if its values are whole numbers
    bookkeeping ///< ids, owners, weights, sizes, errors: never shown
};

/// A name's kind, and which quantities come first.
struct RankedName {
    NameKind kind = NameKind::plain;
    int rank = 0; ///< of quantities: 0 is first
};

/// A unit in brackets at the end of the name does not count.
///
/// `components`  of the field: "u" is a displacement as a vector, and any solution as a scalar
RankedName rank_name(std::string_view name, std::size_t components);

} // namespace isotet::core
