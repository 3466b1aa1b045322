// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What other compilers than the software device's say of the kernels: AMD's, by Mesa's null device, and the validator of SPIR-V.
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>

#include <gtest/gtest.h>
#include <unistd.h>

#include "all_shaders.hpp"
#include "bench/kernels/null_device.hpp"
#include "bench/kernels/pipelines.hpp"
#include "support/run_program.hpp"
#include "vulkan/devices/float_controls.hpp"

namespace isotet::test {
namespace {

TEST(Pipelines, NameEveryShader) {
    std::set<const vulkan::ShaderCode*> used;
    for (const bench::Pipeline& pipeline : bench::all_pipelines())
        for (const bench::Stage& stage : pipeline.stages) used.insert(stage.code);
    for (const vulkan::ShaderCode* shader : vulkan::all_shaders::every)
        EXPECT_TRUE(used.contains(shader)) << shader->name;
}

/// Compiles for one family; `emit` holds at least that many waves a SIMD.
void expect_no_spills(const char* family, std::uint64_t waves, std::uint64_t waves_with_many_edges) {
    const std::string driver = bench::driver_beside_software_device().value();
    const auto device = bench::NullDevice::open(driver, family).value();
    for (const bench::Pipeline& pipeline : bench::all_pipelines()) {
        if (!device->takes(pipeline)) continue;
        for (const bench::Figures& figures : device->compile(pipeline).value()) {
            EXPECT_EQ(figures.spilled_scalars + figures.spilled_vectors + figures.scratch_bytes, 0u)
                << pipeline.name << " (" << pipeline.variant << ") on " << family;
            if (pipeline.name != "emit") continue;
            EXPECT_GE(figures.waves, pipeline.constants[0] != 0 ? waves_with_many_edges : waves)
                << pipeline.variant << " on " << family;
        }
    }
}

TEST(CompilerOfAmd, SpillsNothingOnNavi31) { expect_no_spills("navi31", 22, 20); }
TEST(CompilerOfAmd, SpillsNothingOnNavi21) { expect_no_spills("navi21", 22, 20); }
TEST(CompilerOfAmd, SpillsNothingOnVega10) { expect_no_spills("vega10", 6, 5); }

TEST(Modules, AreValidWithEverySetOfConstants) {
    const std::filesystem::path folder =
        std::filesystem::temp_directory_path() / ("isotet-modules-" + std::to_string(getpid()));
    std::filesystem::create_directories(folder);
    std::set<std::vector<std::uint32_t>> seen;
    for (const bench::Pipeline& pipeline : bench::all_pipelines())
        for (const bench::Stage& stage : pipeline.stages)
            for (const bool controls : {false, true}) { // with_float_controls is for kernels only
                if (controls && pipeline.draws()) continue;
                const auto words = vulkan::with_float_controls(bench::specialized(*stage.code, pipeline.constants),
                                                               {controls, controls});
                if (!seen.insert(words).second) continue;
                const std::filesystem::path file = folder / "module.spv";
                std::ofstream(file, std::ios::binary)
                    .write(reinterpret_cast<const char*>(words.data()), static_cast<std::streamsize>(words.size() * 4));
                const bool is_mesh = stage.stage == VK_SHADER_STAGE_MESH_BIT_EXT;
                const RunResult ran =
                    run_program({"/usr/bin/env", "spirv-val", "--target-env", is_mesh ? "vulkan1.2" : "vulkan1.1",
                                 "--scalar-block-layout", file.string()});
                EXPECT_EQ(ran.status, 0) << stage.code->name << " (" << pipeline.variant << "): " << ran.err << ran.out;
            }
    EXPECT_GT(seen.size(), 100u);
    std::filesystem::remove_all(folder);
}

std::set<std::string> with_capability(std::uint32_t capability) {
    std::set<std::string> names;
    for (const vulkan::ShaderCode* shader : vulkan::all_shaders::every)
        for (std::size_t i = 5; i < shader->words.size() && (shader->words[i] & 0xffff) == 17; i += 2) // OpCapability
            if (shader->words[i + 1] == capability) names.insert(shader->name);
    return names;
}

TEST(Modules, NeedNoNumbersOf64Bits) {
    constexpr std::uint32_t float64 = 10, int64 = 11, int64_atomics = 12;
    EXPECT_EQ(with_capability(float64), (std::set<std::string>{"volume_rays"})) << "has volume_rays_without_doubles";
    EXPECT_EQ(with_capability(int64), std::set<std::string>());
    EXPECT_EQ(with_capability(int64_atomics), std::set<std::string>());
}

TEST(Modules, ThatAreSpoiledAreNotValid) {
    std::vector<std::uint32_t> words = bench::specialized(*vulkan::all_shaders::every[0], {});
    words[3] = 1; // bound of ids
    const std::filesystem::path file =
        std::filesystem::temp_directory_path() / ("isotet-module-" + std::to_string(getpid()) + ".spv");
    std::ofstream(file, std::ios::binary)
        .write(reinterpret_cast<const char*>(words.data()), static_cast<std::streamsize>(words.size() * 4));
    EXPECT_EQ(run_program({"/usr/bin/env", "spirv-val", "--target-env", "vulkan1.2", file.string()}).status, 1);
    std::filesystem::remove(file);
}

} // namespace
} // namespace isotet::test
