// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Device memory by address. An index counts elements and must stay below 2^31: arrays of a whole surface may be longer, and
// are reached through an address that was advanced to where a cluster's part begins.
#ifndef ISOTET_MEMORY_GLSL
#define ISOTET_MEMORY_GLSL

#extension GL_EXT_buffer_reference : require
#extension GL_EXT_buffer_reference_uvec2 : require

#include "shared/layout.h"

layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Words {
    uint at[];
};
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Floats {
    float at[];
};
layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer TablesAt {
    Tables tables;
};
layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Pages {
    Page at[];
};
layout(buffer_reference, scalar, buffer_reference_align = 16) readonly buffer Clusters {
    Cluster at[];
};
layout(buffer_reference, scalar, buffer_reference_align = 8) buffer Ranges {
    Range at[];
};
layout(buffer_reference, scalar, buffer_reference_align = 8) buffer Counts {
    Count at[];
};
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Starts {
    Start at[];
};
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer ListsAt {
    Lists lists;
};
layout(buffer_reference, scalar, buffer_reference_align = 4) buffer OutputAt {
    Output surface;
};

/// address + count * stride.
Address advance(Address address, uint count, uint stride) {
    uint high, low, carry;
    umulExtended(count, stride, high, low);
    low = uaddCarry(address.x, low, carry);
    return Address(low, address.y + high + carry);
}

#endif
