// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Point fields at vertices.
#pragma once

#include <cstddef>
#include <cstdint>

#include "ops/extraction.hpp"

namespace isotet::cpu {

/// A run of vertices: the points at the ends of their edges (the user's, or packed ones), and where between them they lie.
template <class Real>
struct VertexRun {
    const std::uint64_t* below;
    const std::uint64_t* above;
    const Real* weights;
    std::size_t count;
};

/// Writes a field at the vertices of a run, with points as the field's values have them: `count` x components numbers.
template <class Real>
void write_field(const ops::CarriedField& field, const VertexRun<Real>& vertices, Real* out);

} // namespace isotet::cpu
