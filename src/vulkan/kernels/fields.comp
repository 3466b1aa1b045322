// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Interpolates a point field between the ends of each vertex. An invocation a vertex. Same as cpu/field_writer.cpp.
#version 460
#include "shared/surface.glsl"

layout(push_constant, scalar) uniform Push {
    FieldPush push;
};

void main() {
    const Output surface = OutputAt(push.surface).surface;
    const uint vertex = item_index();
    if (surface.overflow != 0u || vertex >= surface.vertices_low) return;
    const uint stride = 4u * push.components;
    Words ends = Words(advance(surface.ends, vertex, 8u));
    const float t = Floats(advance(surface.weights, vertex, 4u)).at[0];
    Floats below = Floats(advance(push.values, ends.at[0], stride));
    Floats above = Floats(advance(push.values, ends.at[1], stride));
    Floats to = Floats(advance(push.field, vertex, stride));
    for (uint k = 0u; k < push.components; ++k) to.at[k] = interpolate_field(below.at[k], above.at[k], t);
}
