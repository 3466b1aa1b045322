// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// A machine without a device is one, too.
#include <isotet/device.hpp>

int main() {
    const auto list = isotet::list_devices();
    return list && (!list->devices.empty() || !list->unavailable.empty()) ? 0 : 1;
}
