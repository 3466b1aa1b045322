// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Fragments of translucent meshes: each joins the list of its sample. resolve.comp puts the lists in order.
// A sheet seen at a slant is as much denser as the way through it is longer.
#version 460
#define ISOTET_FRAGMENT
#include "mesh.glsl"

// What lies behind something opaque never gets here.
layout(early_fragment_tests) in;

// Nothing is written into the images.
void main() {
    const View view = ViewAt(push.view).view;
    const Mesh mesh = MeshAt(push.item).mesh;
    const Shading shading = shade(view, mesh);
    if (gl_HelperInvocation) return;
    const float opacity = 1.0 - pow(1.0 - min(mesh.opacity, 0.999), 1.0 / max(shading.facing, 0.2));

    FragmentListAt list = FragmentListAt(view.fragments);
    const uint index = atomicAdd(list.list.count, 1u);
    if (index >= view.fragment_room) {
        // The processor sees the count, makes room, and draws again. So many that the count would begin anew have room nowhere.
        if (index > 0xf0000000u) atomicExchange(list.list.count, 0xf0000000u);
        return;
    }
    const uint row = view.width * view.samples;
    Words head = Words(advance(view.heads, uint(gl_FragCoord.y) * row + uint(gl_FragCoord.x), 4u));
    FragmentAt place = fragment_at(view, index);
    place.fragment.depth = gl_FragCoord.z;
    place.fragment.red_green = packHalf2x16(shading.color.rg);
    place.fragment.blue_opacity = packHalf2x16(vec2(shading.color.b, opacity));
    place.fragment.next = atomicExchange(head.at[0], index + 1u);
}
