// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// How kernels reach what volume.h describes.
#ifndef ISOTET_VOLUME_GLSL
#define ISOTET_VOLUME_GLSL

#include "shared/exact_double.glsl"
#include "volume.h"
#include "shared/memory.glsl"
#include "shared/arithmetic.glsl"

layout(constant_id = 0) const bool parallel = false;
layout(constant_id = 1) const bool seeks_isosurfaces = false;

layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer SceneAt {
    VolumeScene scene;
};
layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer PlacesAt {
    VolumePlace at[];
};
layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer RowsAt {
    TransferRow at[];
};
layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer Doubles {
    Double at[];
};
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer VolumeClusters {
    VolumeCluster at[];
};
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer TilesAt {
    VolumeTileAt at[];
};
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer EntriesAt {
    VolumeEntry at[];
};
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer RaysAt {
    VolumeRay at[];
};
layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer HitsAt {
    VolumeHit at[];
};
layout(buffer_reference, scalar, buffer_reference_align = 4) coherent buffer PlanesAt {
    VolumePlanes at[];
};
layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer ResultsAt {
    BlockResult at[];
};
layout(buffer_reference, scalar, buffer_reference_align = 16) buffer Quads {
    vec4 at[];
};

layout(push_constant, scalar) uniform Push {
    VolumePush push;
};

#define ISOTET_INFINITY uintBitsToFloat(0x7f800000u)

/// As std::min and std::max, which keep the first of equals.
float lesser(float a, float b) { return b < a ? b : a; }
float greater(float a, float b) { return a < b ? b : a; }

#endif
