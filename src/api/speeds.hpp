// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// measure_speeds() on a made grid of another size, for tests that have no two seconds.
#pragma once

#include <cstdint>

#include <isotet/choose.hpp>

namespace isotet::api {

/// `side`   cubes along an edge of the larger of the two grids
Result<Speeds> measure_speeds(std::uint64_t side, int threads, const Progress& progress);
Result<DeviceSpeeds> measure_speeds(const Device& device, std::uint64_t side, int threads, const Progress& progress);

} // namespace isotet::api
