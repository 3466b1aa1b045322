// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Where barriers must stand in a list of passes, from what each says it reads and writes. No Vulkan calls.
#pragma once

#include <cstdint>
#include <map>
#include <span>

#include "vulkan/devices/functions.hpp"

namespace isotet::vulkan {

/// How a pass uses a buffer.
enum class Access : std::uint8_t {
    kernel_read,
    kernel_write, ///< also of a kernel that reads and writes
    copy_read,
    copy_write, ///< also fills
    arguments,  ///< of an indirect dispatch
    draw_read,  ///< by shaders of draws, as indices, or as arguments of indirect draws
    draw_write, ///< by fragment shaders, which may read as well
    mesh_read,  ///< by mesh shaders, of devices that have them
};

struct BufferUse {
    std::uint64_t buffer; ///< any number that tells buffers apart
    Access access;
};

/// The barrier before a pass; none where both stages are 0.
struct Barrier {
    VkPipelineStageFlags from = 0, to = 0;
    VkAccessFlags written = 0, used = 0;
    friend bool operator==(const Barrier&, const Barrier&) = default;
};

/// Follows a list of passes. A pass waits for the passes before it that wrote what it uses, or used what it writes,
/// unless a barrier since then stands between them already. Whole buffers count: two passes that write different halves
/// are ordered.
class Hazards {
public:
    /// The barrier that must stand before a pass that uses these buffers, the next in the list.
    Barrier before(std::span<const BufferUse> uses);

private:
    struct History {
        VkPipelineStageFlags write_stage = 0; ///< of the last write; 0: none yet
        VkAccessFlags write_access = 0;
        std::uint32_t visible = 0;            ///< a bit for each Access that barriers have made the last write visible
                                              ///< to
        VkPipelineStageFlags read_stages = 0; ///< that read since the last write
        VkPipelineStageFlags after_reads = 0; ///< that barriers make wait for all these reads
    };
    std::map<std::uint64_t, History> buffers_;
};

} // namespace isotet::vulkan
