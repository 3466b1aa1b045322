// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace isotet {

/// How long a pass took on the device: "select", "count", "scan", "emit" and so on.
struct DevicePass {
    std::string name;
    double seconds = 0;
};

/// What a call cost on a device.
struct DeviceWork {
    std::vector<DevicePass> passes;   ///< in order; empty where the device has no timestamps
    double device_seconds = 0;        ///< from the beginning of the first pass to the end of the last, waits between
                                      ///< aside
    double waited_seconds = 0;        ///< for the device, as seen from here
    std::uint64_t uploaded_bytes = 0; ///< over the bus
    std::uint64_t downloaded_bytes = 0;
    std::uint64_t page_loads = 0;  ///< pages that had to be uploaded
    std::uint32_t submissions = 0; ///< one, unless arrays had to grow or pages to come
};

} // namespace isotet
