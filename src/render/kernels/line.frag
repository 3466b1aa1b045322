// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Fragments of lines: one colour.
#version 460
#include "scene.glsl"

layout(push_constant, scalar) uniform Push {
    DrawPush push;
};
layout(location = 0) out vec4 color;

void main() { color = vec4(LinesAt(push.item).lines.color, 1.0); }
