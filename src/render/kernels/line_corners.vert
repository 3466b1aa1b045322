// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Corners of the two triangles that stand for a line: devices need not draw wide lines. Six invocations a line.
#version 460
#include "scene.glsl"

layout(push_constant, scalar) uniform Push {
    DrawPush push;
};

void main() {
    const View view = ViewAt(push.view).view;
    const Lines lines = LinesAt(push.item).lines;
    const uint line = gl_VertexIndex / 6, corner = gl_VertexIndex % 6;
    vec4 a = view.clip_from_scene * vec4(vector_at(lines.ends, 2u * line), 1.0);
    vec4 b = view.clip_from_scene * vec4(vector_at(lines.ends, 2u * line + 1u), 1.0);
    // What lies behind the eye has no place in the picture: the line ends where it gets there.
    const float nearest = 1e-5 * max(a.w, b.w);
    if (a.w < nearest) a = mix(b, a, (b.w - nearest) / (b.w - a.w));
    if (b.w < nearest) b = mix(a, b, (a.w - nearest) / (a.w - b.w));
    const vec2 size = vec2(view.width, view.height) * float(view.samples) * 0.5;
    const vec2 way = (b.xy / b.w - a.xy / a.w) * size;
    const vec2 along = dot(way, way) > 0.0 ? normalize(way) : vec2(1.0, 0.0);
    const vec2 aside = vec2(-along.y, along.x);
    const bool at_end = corner == 1u || corner == 3u || corner == 4u;
    const bool left = corner == 0u || corner == 1u || corner == 3u;
    vec4 place = at_end ? b : a;
    place.xy += ((at_end ? along : -along) + (left ? aside : -aside)) * lines.half_width / size * place.w;
    place.z = max(place.z - lines.lift * place.w, 0.0);
    gl_Position = place;
}
