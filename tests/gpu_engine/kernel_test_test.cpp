// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "device/kernel_test.hpp"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "gpu_engine/engines.hpp"
#include "support/temporary_folder.hpp"
#include "vulkan/engine/kernel_hash.hpp"

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

TEST_F(KernelTest, IsRunAgainWhenTheNoteNamesOtherKernels) {
    const TemporaryFolder folder;
    vulkan::Settings settings = watched();
    settings.cache_folder = folder.file("cache");
    reopen(settings);
    const std::filesystem::path note = context().pipeline_cache().file().string() + ".tested";
    ASSERT_TRUE(test_kernels_once(device()));
    const auto noted = [&] {
        std::ifstream in(note);
        return std::string(std::istreambuf_iterator<char>(in), {});
    };
    const std::string right = noted();
    EXPECT_EQ(right, fmt::format("{:016x}", vulkan::kernel_hash()));
    const auto kernels_made = [&] {
        const std::size_t before = context().kernels().count();
        EXPECT_TRUE(test_kernels_once(device()));
        return context().kernels().count() - before;
    };
    reopen(settings);
    EXPECT_EQ(kernels_made(), 0u) << "no kernel is made";
    std::ofstream(note) << "1";
    EXPECT_GT(kernels_made(), 0u);
    EXPECT_EQ(noted(), right);
}

TEST(KernelHash, IsAnotherForAnotherWordOrName) {
    const std::uint32_t words[] = {1, 2, 3}, others[] = {1, 2, 4};
    const vulkan::ShaderCode a{"a", words}, same{"a", words}, other_words{"a", others}, other_name{"b", words};
    const auto hash = [](const vulkan::ShaderCode& code) {
        const vulkan::ShaderCode* const one[] = {&code};
        return vulkan::hash_of(one);
    };
    EXPECT_EQ(hash(a), hash(same));
    EXPECT_NE(hash(a), hash(other_words));
    EXPECT_NE(hash(a), hash(other_name));
}

} // namespace
} // namespace isotet::test
