// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Measured speeds, kept between runs in speeds.json of the cache folder: one entry a processor and number of threads,
// one a device and driver. Losing the file, or failing to write it, costs a second of measuring and nothing else.
#pragma once

#include <istream>
#include <optional>
#include <string>

#include <isotet/choose.hpp>
#include <isotet/device.hpp>

namespace isotet::cli {

/// What is kept under "AMD EPYC 9B14, 2 threads" and the like. Nothing: not measured yet, or over 90 days ago, or by
/// another build of isotet.
std::optional<Speeds> kept_speeds(const std::string& key);
std::optional<DeviceSpeeds> kept_device_speeds(const std::string& key);

void keep(const std::string& key, const Speeds& speeds);
void keep(const std::string& key, const DeviceSpeeds& speeds);

/// What the kernel tells of the processor in /proc/cpuinfo: its name or, of ARM, "ARM 0x41/0xd0c", implementer and
/// part; of several kinds all. "a processor" where it tells nothing.
std::string processor_name(std::istream& cpuinfo);

std::string processor_key(int threads); ///< 0: all
std::string device_key(const DeviceInfo& info, int threads);

} // namespace isotet::cli
