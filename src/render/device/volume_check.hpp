// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Does a device follow rays as the processor does? Asked before it follows any.
#pragma once

#include <isotet/scene.hpp>

#include "render/volume/ray_batch.hpp"

namespace isotet::render {

/// Whether the rays of a small volume, with all that there may be in one, meet the same with the same bits.
///
/// Cost     10 ms of the processor, and what the device takes
/// Errors   as RayFollower
Result<bool> follows_as_processor(RayFollower& follower, Seek seek, Projection projection);

} // namespace isotet::render
