// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Gradient normals of a surface from plain arrays: the gradient at the ends of its edges alone.
#pragma once

#include "cpu/direct/emit.hpp"

namespace isotet::cpu::direct {

struct GradientNormals {
    Array normals;         ///< float32 x 3, V
    bool saw_flat = false; ///< a flat tet was added up, for which `mostly_negative` matters
};

/// `sides`    tells points without data
/// `surface`  with ends and weights
/// Cost       two passes over the cells; 4 bytes (8 from 2^32 cells on) for each tet at each end of an edge
/// Errors     out_of_memory; cancelled
template <class Real>
Result<GradientNormals> gradient_normals(const VertexSource<Real>& source, const Sides& sides, bool mostly_negative,
                                         const ops::RawSurface& surface, const Progress& progress);

} // namespace isotet::cpu::direct
