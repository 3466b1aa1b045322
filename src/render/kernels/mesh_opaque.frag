// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Fragments of opaque meshes: their colour, in linear light.
#version 460
#define ISOTET_FRAGMENT
#include "mesh.glsl"

layout(location = 0) out vec4 color;

void main() { color = vec4(shade(ViewAt(push.view).view, MeshAt(push.item).mesh).color, 1.0); }
