// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What a surface carries beyond its geometry; the same code after every engine. Arrays are made in `slot`.
#pragma once

#include <isotet/extract.hpp>

#include "base/array_slot.hpp"
#include "ops/extraction.hpp"
#include "packed/packed.hpp"

namespace isotet::api {

/// A point field of the user's grid at the vertices: stored by the rules for values, interpolated between the edge
/// ends; in stored form.
/// Cost   O(V)
template <class Real>
Array interpolate_field(const Field& field, const core::Storage& storage, const ops::RawSurface& raw,
                        const core::ArraySlot& slot);

/// A cell field of the user's grid at the triangles, in its own type.
Field copy_cell_field(const Field& field, const ops::RawSurface& raw, const core::ArraySlot& slot);

constexpr std::size_t fill_normals_bytes = 16;

/// One normal a triangle.
template <class Real>
Array face_normals(const ops::RawSurface& raw, const core::ArraySlot& slot);

/// Replaces gradient normals that are zero by the face normal of the lowest-numbered triangle at the vertex: in the
/// array itself, to which only the engine and the caller may refer.
/// Cost   at most fill_normals_bytes a vertex, of memory; nothing where no normal is zero
template <class Real>
Array fill_normals(const ops::RawSurface& raw);

} // namespace isotet::api
