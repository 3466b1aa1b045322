// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Normals of many triangles.
#pragma once

#include <cstddef>

namespace isotet::cpu {

/// core::face_normal() of `count` triangles with corners in `positions`, one after another in `out`.
/// Guarantees   the same bytes on every instruction level
template <class Real, class Index>
void face_normals(const Real* positions, const Index* triangles, std::size_t count, float* out);

} // namespace isotet::cpu
