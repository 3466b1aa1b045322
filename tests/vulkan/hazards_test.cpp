// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Barriers follow from what passes say they use: none is missing, and none is there without need. A software device
// would not notice a missing one, so the rules of Vulkan are played through here on the list of passes alone.
#include <algorithm>
#include <random>
#include <sstream>
#include <vector>

#include <gtest/gtest.h>

#include "vulkan/groups.hpp"
#include "vulkan/hazards.hpp"

namespace isotet::test {
namespace {

using vulkan::Access;
using vulkan::Barrier;
using vulkan::BufferUse;
using vulkan::Hazards;

constexpr VkPipelineStageFlags compute = VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
                               transfer = VK_PIPELINE_STAGE_TRANSFER_BIT,
                               indirect = VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT,
                               draw_stages = VK_PIPELINE_STAGE_VERTEX_INPUT_BIT | VK_PIPELINE_STAGE_VERTEX_SHADER_BIT |
                                             VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT;

Barrier next(Hazards& hazards, std::vector<BufferUse> uses) { return hazards.before(uses); }

TEST(Hazards, ReadersOfAWriteWaitForIt) {
    Hazards hazards;
    EXPECT_EQ(next(hazards, {{1, Access::kernel_write}}), Barrier{});
    EXPECT_EQ(next(hazards, {{1, Access::kernel_read}}),
              (Barrier{compute, compute, VK_ACCESS_SHADER_WRITE_BIT, VK_ACCESS_SHADER_READ_BIT}));
    EXPECT_EQ(next(hazards, {{1, Access::kernel_read}}), Barrier{}) << "it has waited already";
    EXPECT_EQ(next(hazards, {{1, Access::arguments}}),
              (Barrier{compute, indirect, VK_ACCESS_SHADER_WRITE_BIT, VK_ACCESS_INDIRECT_COMMAND_READ_BIT}))
        << "the barrier before was for kernels only";
    EXPECT_EQ(next(hazards, {{1, Access::copy_read}}),
              (Barrier{compute, transfer, VK_ACCESS_SHADER_WRITE_BIT, VK_ACCESS_TRANSFER_READ_BIT}));
}

TEST(Hazards, WritersWaitForReaders) {
    Hazards hazards;
    EXPECT_EQ(next(hazards, {{1, Access::copy_read}}), Barrier{});
    EXPECT_EQ(next(hazards, {{1, Access::kernel_write}}), (Barrier{transfer, compute, 0, 0}));
}

TEST(Hazards, WritersWaitForWriters) {
    Hazards hazards;
    next(hazards, {{1, Access::copy_write}});
    EXPECT_EQ(next(hazards, {{1, Access::kernel_write}}),
              (Barrier{transfer, compute, VK_ACCESS_TRANSFER_WRITE_BIT,
                       VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT}));
}

TEST(Hazards, PassesOnDifferentBuffersDoNotWait) {
    Hazards hazards;
    for (std::uint64_t buffer = 0; buffer < 10; ++buffer)
        EXPECT_EQ(next(hazards, {{buffer, Access::kernel_write}, {99, Access::kernel_read}}), Barrier{}) << buffer;
}

TEST(Hazards, WhatKernelsSeeDrawsNeedNotSee) {
    Hazards hazards;
    next(hazards, {{1, Access::copy_write}});
    next(hazards, {{1, Access::kernel_read}});
    const Barrier barrier = next(hazards, {{1, Access::draw_write}});
    EXPECT_EQ(barrier.from, transfer | compute);
    EXPECT_EQ(barrier.to, VkPipelineStageFlags{VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT});
    EXPECT_EQ(barrier.written, VkAccessFlags{VK_ACCESS_TRANSFER_WRITE_BIT});
}

TEST(Hazards, OneBarrierServesAllBuffers) {
    Hazards hazards;
    next(hazards, {{1, Access::kernel_write}});
    next(hazards, {{2, Access::kernel_write}});
    EXPECT_NE(next(hazards, {{1, Access::kernel_read}}), Barrier{});
    EXPECT_EQ(next(hazards, {{2, Access::kernel_read}}), Barrier{});
}

/// What every pass of a list knows of every write before it, by Vulkan's rules for execution and memory dependencies,
/// with barriers as given: kept in the simplest possible way, for lists of a few passes.
class Model {
public:
    void add(const Barrier& barrier, const std::vector<BufferUse>& uses) {
        barriers_.push_back(barrier);
        passes_.push_back(uses);
    }

    /// A pair of uses that are not ordered, or whose write is not visible; empty when all is well.
    std::string fault() const {
        for (std::size_t late = 0; late < passes_.size(); ++late)
            for (std::size_t early = 0; early < late; ++early)
                for (const BufferUse& a : passes_[early])
                    for (const BufferUse& b : passes_[late])
                        if (a.buffer == b.buffer && (writes(a) || writes(b)) && !safe(early, a, late, b)) {
                            std::ostringstream text;
                            text << "pass " << late << " does not wait for pass " << early << " at buffer " << a.buffer;
                            return text.str();
                        }
        return {};
    }

private:
    static bool writes(const BufferUse& use) {
        return use.access == Access::kernel_write || use.access == Access::copy_write ||
               use.access == Access::draw_write;
    }
    static VkPipelineStageFlags stage(const BufferUse& use) {
        if (use.access == Access::arguments) return indirect;
        if (use.access == Access::draw_write) return VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT;
        if (use.access == Access::draw_read) return indirect | draw_stages;
        if (use.access == Access::mesh_read) return VK_PIPELINE_STAGE_MESH_SHADER_BIT_EXT;
        return use.access == Access::copy_read || use.access == Access::copy_write ? transfer : compute;
    }
    static bool covers(VkFlags flags, VkFlags wanted) { return (flags & wanted) == wanted; }
    static VkAccessFlags access(const BufferUse& use) {
        switch (use.access) {
        case Access::kernel_read: return VK_ACCESS_SHADER_READ_BIT;
        case Access::kernel_write: return VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT;
        case Access::copy_read: return VK_ACCESS_TRANSFER_READ_BIT;
        case Access::copy_write: return VK_ACCESS_TRANSFER_WRITE_BIT;
        case Access::draw_read:
            return VK_ACCESS_INDIRECT_COMMAND_READ_BIT | VK_ACCESS_INDEX_READ_BIT | VK_ACCESS_SHADER_READ_BIT;
        case Access::draw_write: return VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT;
        case Access::mesh_read: return VK_ACCESS_SHADER_READ_BIT;
        case Access::arguments: break;
        }
        return VK_ACCESS_INDIRECT_COMMAND_READ_BIT;
    }

    /// Ordered by a single barrier between them, and for a write made available and visible by it. (Chains of barriers
    /// would do as well; the recorder does not count on them.)
    bool safe(std::size_t early, const BufferUse& a, std::size_t late, const BufferUse& b) const {
        for (std::size_t i = early + 1; i <= late; ++i) {
            const Barrier& between = barriers_[i];
            if (!covers(between.from, stage(a)) || !covers(between.to, stage(b))) continue;
            if (!writes(a)) return true;
            const VkAccessFlags write = access(a) & (VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_TRANSFER_WRITE_BIT);
            if ((between.written & write) && covers(between.used, access(b))) return true;
        }
        // An overwritten value: whoever overwrote it is ordered after the first and before the last.
        for (std::size_t middle = early + 1; middle < late; ++middle)
            for (const BufferUse& c : passes_[middle])
                if (c.buffer == a.buffer && writes(c) && safe(early, a, middle, c) && safe(middle, c, late, b))
                    return true;
        return false;
    }

    std::vector<Barrier> barriers_;
    std::vector<std::vector<BufferUse>> passes_;
};

std::vector<BufferUse> random_uses(std::mt19937& random) {
    std::vector<BufferUse> uses;
    const auto kind = random() % 3;
    for (std::uint64_t n = 1 + random() % 3; n > 0; --n) {
        const std::uint64_t buffer = random() % 4;
        const Access of_kernel[] = {Access::kernel_read, Access::kernel_write, Access::arguments};
        const Access of_copy[] = {Access::copy_read, Access::copy_write};
        const Access of_draw[] = {Access::draw_read, Access::draw_write, Access::mesh_read};
        const Access access = kind == 0   ? of_kernel[random() % 3]
                              : kind == 1 ? of_copy[random() % 2]
                                          : of_draw[random() % 3];
        const auto same = [&](const BufferUse& use) { return use.buffer == buffer; };
        if (kind != 1 || std::none_of(uses.begin(), uses.end(), same)) uses.push_back({buffer, access});
    }
    return uses;
}

TEST(Hazards, LeaveNoPairOfUsesUnordered) {
    for (unsigned seed = 0; seed < 3000; ++seed) {
        std::mt19937 random(seed);
        Hazards hazards;
        Model model;
        for (int pass = 0; pass < 8; ++pass) {
            const std::vector<BufferUse> uses = random_uses(random);
            model.add(hazards.before(uses), uses);
        }
        ASSERT_EQ(model.fault(), "") << "seed " << seed;
    }
}

TEST(Hazards, TheModelNoticesAMissingBarrier) {
    unsigned noticed = 0, lists = 0;
    for (unsigned seed = 0; seed < 300; ++seed) {
        std::mt19937 random(seed);
        Hazards hazards;
        Model model;
        bool left_out = false;
        for (int pass = 0; pass < 8; ++pass) {
            const std::vector<BufferUse> uses = random_uses(random);
            Barrier barrier = hazards.before(uses);
            if (barrier.from && !left_out) {
                barrier = {};
                left_out = true;
            }
            model.add(barrier, uses);
        }
        lists += left_out;
        noticed += !model.fault().empty();
    }
    EXPECT_GT(noticed, 100u);
    EXPECT_GT(lists, 200u);
}

TEST(Groups, AreFoldedIntoThreeAxesWithFewTooMany) {
    for (const std::uint64_t limit : {1u, 2u, 7u, 1000u, 65535u}) {
        for (const std::uint64_t count :
             {std::uint64_t{1}, limit, limit + 1, limit * limit, limit * limit + 1, limit * limit * limit}) {
            const auto folded = vulkan::fold_groups(count, limit);
            if (count > limit * limit * limit) {
                EXPECT_FALSE(folded) << count << " by " << limit;
                continue;
            }
            ASSERT_TRUE(folded) << count << " by " << limit;
            const auto [x, y, z] = *folded;
            const std::uint64_t all = std::uint64_t{x} * y * z;
            EXPECT_LE(std::max({x, y, z}), limit) << count;
            EXPECT_GE(all, count) << limit;
            EXPECT_LT(all - count, std::uint64_t{z} * y + z) << count << " by " << limit;
        }
    }
    EXPECT_EQ(vulkan::fold_groups(0, 7)->at(0), 0u);
    EXPECT_FALSE(vulkan::fold_groups(344, 7));
    EXPECT_EQ(*vulkan::fold_groups(65536, 65535), (vulkan::Groups{32768, 2, 1}));
}

} // namespace
} // namespace isotet::test
