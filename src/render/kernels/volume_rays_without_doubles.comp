// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The same for devices without shaderFloat64.
#version 460
#define ISOTET_INTEGER_DOUBLES
#include "volume_rays.glsl"
