// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Whether a driver has built the kernels as they are written.
#pragma once

#include <isotet/device.hpp>

namespace isotet {

/// Extracts from two small grids, of tets and of all kinds of cells, with ties, and compares every byte with the CPU engine's.
/// On a device whose arithmetic is known to be inexact only the triangles are compared.
///
/// Errors   no_device when a surface differs, with the name of the device; those of DeviceGrid
ISOTET_API Result<void> test_kernels(const Device& device);

/// The same, where these very kernels have not been found right with this driver before.
ISOTET_API Result<void> test_kernels_once(const Device& device);

} // namespace isotet
