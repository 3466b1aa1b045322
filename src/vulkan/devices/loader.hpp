// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The Vulkan loader, opened at run time.
#pragma once

#include <isotet/result.hpp>

#include "vulkan/devices/functions.hpp"

namespace isotet::vulkan {

/// The functions of libvulkan.so.1, opened once a process and never closed.
///
/// Errors    machine when there is none, or when it knows only Vulkan 1.0
/// Threads   safe from many threads
Result<LoaderFunctions> loader();

} // namespace isotet::vulkan
