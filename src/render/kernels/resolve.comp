// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Writes the pixels of a part of the picture: what is translucent over what is opaque over the background, for every sample,
// then the mean of a pixel's samples. An invocation a pixel.
//
// Fragments come nearest first, found by going through the sample's list again and again: few samples have many, and no list
// is too long. Of fragments at one depth the one with the larger colour word comes first, so that the order in which they
// were drawn shows nowhere.
#version 460
#include "scene.glsl"
#include "shared/groups.glsl"

layout(local_size_x = 64) in;

layout(push_constant, scalar) uniform Push {
    ResolvePush push;
};

/// What orders fragments: depth first. Depths are not negative, so their bits ascend as they do.
struct Key {
    uint depth, red_green, blue_opacity;
};
bool before(Key a, Key b) {
    if (a.depth != b.depth) return a.depth < b.depth;
    if (a.red_green != b.red_green) return a.red_green > b.red_green;
    return a.blue_opacity > b.blue_opacity;
}

/// Colour (times opacity) and opacity of all translucent fragments of a sample.
vec4 translucent_at(View view, uint head) {
    vec4 seen = vec4(0.0);
    bool any = false;
    Key last = Key(0u, 0u, 0u);
    while (seen.a < 0.998) {
        bool found = false;
        Key nearest = last;
        uint times = 0u; // fragments that are the same in everything
        for (uint at = head; at != 0u;) {
            const Fragment fragment = fragment_at(view, at - 1u).fragment;
            at = fragment.next;
            const Key key = Key(floatBitsToUint(fragment.depth), fragment.red_green, fragment.blue_opacity);
            if (any && !before(last, key)) continue;
            if (found && key == nearest) ++times;
            if (found && !before(key, nearest)) continue;
            nearest = key;
            found = true;
            times = 1u;
        }
        if (!found) break;
        const vec2 red_green = unpackHalf2x16(nearest.red_green), blue_opacity = unpackHalf2x16(nearest.blue_opacity);
        for (; times > 0u; --times) seen += (1.0 - seen.a) * blue_opacity.y * vec4(red_green, blue_opacity.x, 1.0);
        last = nearest;
        any = true;
    }
    return seen;
}

vec4 opaque_at(View view, uint sample_index) {
    Words words = Words(advance(view.colors, sample_index, 8u));
    return vec4(unpackHalf2x16(words.at[0]), unpackHalf2x16(words.at[1]));
}

/// Linear light as the numbers of a picture (sRGB).
vec3 encoded(vec3 light) {
    const vec3 low = light * 12.92, high = 1.055 * pow(max(light, vec3(0.0031308)), vec3(1.0 / 2.4)) - 0.055;
    return mix(low, high, greaterThan(light, vec3(0.0031308)));
}

void main() {
    const View view = ViewAt(push.view).view;
    const uint pixel = group_index() * resolve_size + gl_LocalInvocationIndex;
    if (pixel >= view.width * view.height) return;
    const uint x = pixel % view.width, y = pixel / view.width;
    vec4 sum = vec4(0.0);
    for (uint j = 0u; j < view.samples; ++j) {
        for (uint i = 0u; i < view.samples; ++i) {
            const uint sample_index = (y * view.samples + j) * view.width * view.samples + x * view.samples + i;
            const vec4 behind = opaque_at(view, sample_index);
            vec4 front = vec4(0.0);
            if (view.fragment_room > 0u) front = translucent_at(view, word_at(view.heads, sample_index));
            sum += front + (1.0 - front.a) * behind;
        }
    }
    sum /= float(view.samples * view.samples);
    sum += (1.0 - sum.a) * view.background_opacity * vec4(view.background, 1.0);
    const vec3 color = sum.a > 0.0 ? encoded(clamp(sum.rgb / sum.a, 0.0, 1.0)) : vec3(0.0);
    Words(advance(view.pixels, pixel, 4u)).at[0] = packUnorm4x8(vec4(color, sum.a));
}
