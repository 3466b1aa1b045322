// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/device.hpp>

namespace isotet {

std::string_view name_of(DeviceKind kind) noexcept {
    switch (kind) {
    case DeviceKind::discrete: return "discrete GPU";
    case DeviceKind::integrated: return "integrated GPU";
    case DeviceKind::virtual_gpu: return "virtual GPU";
    case DeviceKind::software: return "software";
    case DeviceKind::other: break;
    }
    return "other";
}

} // namespace isotet
