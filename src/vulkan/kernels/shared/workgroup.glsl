// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What the 128 invocations of a workgroup do together. Only shared memory and barriers: a subgroup may have any size, and
// may hold any invocations.
#ifndef ISOTET_WORKGROUP_GLSL
#define ISOTET_WORKGROUP_GLSL

#extension GL_EXT_control_flow_attributes : require

layout(local_size_x = 128) in;

const uint workgroup_size = 128u;
const uint chunk = 8u;

#endif
