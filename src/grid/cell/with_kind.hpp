// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <type_traits>

#include "grid/cell/cell_kind.hpp"

namespace isotet::core {

/// Calls use() with the kind as a constant, so that loops over its faces and their corners have known lengths.
template <class Use>
void with_kind(CellKind kind, const Use& use) {
    switch (kind) {
    case CellKind::tetrahedron: return use(std::integral_constant<CellKind, CellKind::tetrahedron>());
    case CellKind::pyramid: return use(std::integral_constant<CellKind, CellKind::pyramid>());
    case CellKind::wedge: return use(std::integral_constant<CellKind, CellKind::wedge>());
    case CellKind::hexahedron: return use(std::integral_constant<CellKind, CellKind::hexahedron>());
    }
}

} // namespace isotet::core
