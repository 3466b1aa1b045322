// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What a picture shows of a volume, in a device's memory: the clusters that some tile may show, each with copies of the points
// that it borrows, and its tets that are not transparent.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <isotet/progress.hpp>
#include <isotet/result.hpp>

#include "render/device/volume_layout.hpp"
#include "render/volume/placed_volume.hpp"
#include "vulkan/context.hpp"
#include "vulkan/recorder.hpp"

namespace isotet::render {

class VolumeOnDevice {
public:
    /// Errors   invalid_data with 2^32 points or tets; out_of_memory; device_failed; as Residency::bring()
    static Result<VolumeOnDevice> upload(vulkan::Context& context, const PlacedVolume& volume,
                                         const Progress& progress);

    /// Without windows.
    layout::VolumePlace place() const;
    std::uint32_t number_of(std::uint32_t cluster) const { return numbers_[cluster]; }
    void add_uses(std::vector<vulkan::Use>& uses) const;
    std::uint64_t bytes() const;

private:
    layout::VolumePlace place_{};
    std::vector<std::uint32_t> numbers_; ///< of each cluster of the grid among those that are here
    vulkan::Buffer positions_, values_, clusters_, tets_, table_, heights_;
};

} // namespace isotet::render
