// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#version 460
#include "volume_rays.glsl"
