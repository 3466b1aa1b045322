// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The structs of kernels/shared/layout.h: kernels find every member where C++ has it.
#include <cstddef>
#include <cstring>
#include <map>
#include <string>

#include "gpu_engine/kernels/members.h"
#include "layout_shaders.hpp"
#include "vulkan/engine/address.hpp"
#include "vulkan/engine/layout.hpp"
#include "vulkan/software_device.hpp"

namespace isotet::test {
namespace {

using namespace vulkan::layout;

/// A member, and the words that it takes from `first` on.
struct Member {
    std::string name;
    std::size_t first, words;
};

std::vector<Member> members() {
    return {
#define ISOTET_MEMBER(variable, type, member)                                                                          \
    {#type "::" #member, offsetof(type, member) / 4, sizeof(static_cast<type*>(nullptr)->member) / 4},
        ISOTET_MEMBERS(ISOTET_MEMBER)
#undef ISOTET_MEMBER
    };
}

TEST(Layout, EveryMemberIsListed) {
    std::map<std::string, std::size_t> words;
    for (const Member& member : members()) words[member.name.substr(0, member.name.find(':'))] += member.words;
#define ISOTET_STRUCT(variable, type) EXPECT_EQ(4 * words[#type], sizeof(type)) << #type;
    ISOTET_STRUCTS(ISOTET_STRUCT)
#undef ISOTET_STRUCT
}

class LayoutOnDevice : public OnDevice {};

TEST_F(LayoutOnDevice, KernelsFindEveryMemberWhereItIs) {
    std::size_t count = 0;
    for (const Member& member : members()) count += member.words;
    const vulkan::Buffer words = upload(ramp(100));
    const vulkan::Buffer places = take(4 * count);
    const struct {
        Address words, places;
    } push{vulkan::address_of(words), vulkan::address_of(places)};
    vulkan::Recorder recorder(context());
    recorder.dispatch(*context().kernels().get(vulkan::layout_shaders::layout).value(), push, 1,
                      {vulkan::reads(words), vulkan::writes(places)});
    recorder.run().value();
    const std::vector<std::uint32_t> found = download(places);
    std::size_t at = 0;
    for (const Member& member : members())
        for (std::size_t k = 0; k < member.words; ++k)
            EXPECT_EQ(found[at++], member.first + k) << member.name << ", word " << k;
}

} // namespace
} // namespace isotet::test
