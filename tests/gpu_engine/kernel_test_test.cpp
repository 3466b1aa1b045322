// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "device/kernel_test.hpp"

#include <vector>

#include "gpu_engine/engines.hpp"

namespace isotet::test {
namespace {

bool miscompiles = false;
PFN_vkCreateShaderModule compile_rightly = nullptr;

/// A driver that subtracts where it should add, from some time on.
VkResult VKAPI_CALL compile_wrongly(VkDevice device, const VkShaderModuleCreateInfo* info,
                                    const VkAllocationCallbacks* allocator, VkShaderModule* module) {
    constexpr std::uint32_t op_fadd = 129, op_fsub = 131;
    std::vector<std::uint32_t> words(info->pCode, info->pCode + info->codeSize / 4);
    for (std::size_t i = 5; miscompiles && i < words.size(); i += words[i] >> 16)
        if ((words[i] & 0xffffu) == op_fadd) words[i] = (words[i] & 0xffff0000u) | op_fsub;
    VkShaderModuleCreateInfo changed = *info;
    changed.pCode = words.data();
    return compile_rightly(device, &changed, allocator, module);
}

class KernelTest : public Engines {};

TEST_F(KernelTest, PassesOnTheSoftwareDevice) {
    const Result<void> tested = test_kernels(device());
    EXPECT_TRUE(tested) << tested.error().message;
}

TEST_F(KernelTest, RefusesADeviceThatMiscompilesByName) {
    vulkan::Settings settings = watched();
    settings.alter_functions = [](vulkan::DeviceFunctions& functions) {
        compile_rightly = functions.vkCreateShaderModule;
        functions.vkCreateShaderModule = &compile_wrongly;
    };
    miscompiles = false; // while the arithmetic is tested
    reopen(settings);
    miscompiles = true;
    const Result<void> tested = test_kernels(device());
    ASSERT_FALSE(tested);
    EXPECT_EQ(tested.error().code, ErrorCode::no_device);
    EXPECT_NE(tested.error().message.find("the device " + context().info().name + " is not used"), std::string::npos)
        << tested.error().message;
}

} // namespace
} // namespace isotet::test
