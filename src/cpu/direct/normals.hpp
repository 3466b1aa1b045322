// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Gradient normals of a surface from plain arrays: the gradient at the ends of its edges alone.
#pragma once

#include <functional>
#include <optional>

#include "cpu/direct/emit.hpp"

namespace isotet::cpu::direct {

/// float32 x 3, V.
///
/// `sides`    tells points without data
/// `most`     whether most tets are negative; where it is not known: asked by `ask_for_most` when a flat tet was added up,
///            for which it matters
/// `surface`  with ends and weights
/// `slot`     where the normals go
/// Cost       two passes over the cells, four where most are negative and that was asked; 4 bytes (8 from 2^32 cells on)
///            for each tet at each end of an edge
/// Errors     out_of_memory; cancelled
template <class Real>
Result<Array> gradient_normals(const VertexSource<Real>& source, const Sides& sides, std::optional<bool> most,
                               const std::function<bool()>& ask_for_most, const ops::RawSurface& surface,
                               const core::ArraySlot& slot, const Progress& progress);

} // namespace isotet::cpu::direct
