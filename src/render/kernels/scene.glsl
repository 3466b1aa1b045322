// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// How shaders reach what scene.h describes.
#ifndef ISOTET_SCENE_GLSL
#define ISOTET_SCENE_GLSL

#include "scene.h"
#include "shared/memory.glsl"

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer ViewAt {
    View view;
};
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer MeshAt {
    Mesh mesh;
};
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer TetPageAt {
    TetPage page;
};
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer LinesAt {
    Lines lines;
};
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer FragmentListAt {
    FragmentList list;
};
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer FragmentAt {
    Fragment fragment;
};

uint word_at(Address words, uint index) { return Words(advance(words, index, 4u)).at[0]; }
float float_at(Address floats, uint index) { return Floats(advance(floats, index, 4u)).at[0]; }
vec3 vector_at(Address vectors, uint index) {
    Floats at = Floats(advance(vectors, index, 12u));
    return vec3(at.at[0], at.at[1], at.at[2]);
}

FragmentAt fragment_at(View view, uint index) { return FragmentAt(advance(advance(view.fragments, 4u, 1u), index, 16u)); }

#endif
