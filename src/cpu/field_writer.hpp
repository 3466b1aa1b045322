// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Point fields of the user's grid at vertices.
#pragma once

#include <cstddef>
#include <cstdint>

#include "ops/extraction.hpp"

namespace isotet::cpu {

/// A run of vertices: the user's points at the ends of their edges, and where between them they lie.
template <class Real>
struct VertexRun {
    const std::uint64_t* below;
    const std::uint64_t* above;
    const Real* weights;
    std::size_t count;
};

/// Writes a field at the vertices of a run: `count` x components numbers.
template <class Real>
void write_field(const ops::CarriedField& field, const VertexRun<Real>& vertices, Real* out);

} // namespace isotet::cpu
