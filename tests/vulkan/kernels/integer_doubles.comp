// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#version 460
#define ISOTET_INTEGER_DOUBLES
#include "doubles.glsl"
