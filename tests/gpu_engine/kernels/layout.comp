// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Reads every struct that crosses to the kernels from the same words, and writes its members one after another: where the words
// are numbered, these are the places of the members. One invocation.
#version 460
#include "shared/memory.glsl"
#include "members.h"

layout(local_size_x = 1) in;

layout(push_constant, scalar) uniform Push {
    Address words;
    Address places;
};

uint count = 0u;
void put(uint word) { Words(places).at[count++] = word; }
void put(float word) { put(floatBitsToUint(word)); }
void put(Address words) {
    put(words.x);
    put(words.y);
}

#define ISOTET_READ(variable, type)                                                                         \
    layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer At_##variable { type of; }; \
    type variable;
#define ISOTET_FILL(variable, type) variable = At_##variable(words).of;
#define ISOTET_PUT(variable, type, member) put(variable.member);

ISOTET_STRUCTS(ISOTET_READ)

void main() {
    ISOTET_STRUCTS(ISOTET_FILL)
    ISOTET_MEMBERS(ISOTET_PUT)
}
