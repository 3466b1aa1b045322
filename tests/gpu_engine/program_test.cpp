// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// `isotet extract` with a device: the same files, and a note whenever the CPU stands in.
#include <fstream>
#include <iterator>

#include "cli/program.hpp"
#include "cli/small_grid.hpp"
#include "vulkan/software_device.hpp"

namespace isotet::test {
namespace {

class ProgramOnDevice : public Program {
protected:
    static std::string content(const std::string& file) {
        std::ifstream in(file, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
};

TEST_F(ProgramOnDevice, WritesTheSameFile) {
    const std::vector<std::string> command{"extract",     "make:kuhn:12:gyroid,sphere",
                                           "-f",          "gyroid",
                                           "-i",          "0,0.3",
                                           "--normals",   "gradient",
                                           "--edge-ends", "-q",
                                           "-o"};
    auto on_cpu = command, on_device = command, in_parts = command;
    on_cpu.insert(on_cpu.end(), {path("cpu.vtp"), "--method", "clusters"});
    on_device.insert(on_device.end(), {path("device.vtp"), "--engine", "vulkan", "--device", test_device()});
    in_parts.insert(in_parts.end(),
                    {path("parts.vtp"), "--engine", "vulkan", "--device", test_device(), "--device-memory", "1MB"});
    for (const auto& words : {on_cpu, on_device, in_parts}) {
        const RunResult run = isotet(words);
        ASSERT_EQ(run.status, 0) << run.err;
    }
    const std::string expected = content(path("cpu.vtp"));
    EXPECT_GT(expected.size(), 10'000u);
    EXPECT_TRUE(content(path("device.vtp")) == expected);
    EXPECT_TRUE(content(path("parts.vtp")) == expected);
}

TEST_F(ProgramOnDevice, TimeStepsSendTheirValuesOnly) {
    put_content(path("g.msh"),
                small_grid({{"p", {0, 1, 1, 1, 2}, 0}, {"p", {0, 2, 2, 2, 4}, 0.1}, {"p", {0, 4, 4, 4, 8}, 2.5}}));
    const auto extract = [&](const std::string& out, std::vector<std::string> more) {
        more.insert(more.begin(), {"extract", path("g.msh"), path(out), "-f", "p", "-i", "1.5", "--all-steps", "-v"});
        const RunResult run = isotet(more);
        EXPECT_EQ(run.status, 0) << run.err;
        return run.err;
    };
    extract("cpu-{time}.vtp", {"--method", "clusters"});
    const std::string said = extract("device-{time}.vtp", {"--engine", "vulkan", "--device", test_device()});
    EXPECT_EQ(said.find("of device memory, "), said.rfind("of device memory, ")) << "uploaded once: " << said;
    EXPECT_NE(said.find("not packed again"), std::string::npos) << said;
    for (const std::string time : {"0", "0.1", "2.5"})
        EXPECT_TRUE(content(path("device-" + time + ".vtp")) == content(path("cpu-" + time + ".vtp"))) << time;
}

TEST_F(ProgramOnDevice, TellsWhatCrossedTheBus) {
    const auto report =
        json_of({"extract", "make:kuhn:8:gyroid", "-i", "0", "--engine", "vulkan", "--device", test_device()});
    EXPECT_EQ(report["engine"], "vulkan");
    const auto& surface = report["surfaces"][0];
    EXPECT_GE(surface["device"]["bytes_down"].get<std::size_t>(),
              12 * (surface["vertices"].get<std::size_t>() + surface["triangles"].get<std::size_t>()));
}

TEST_F(ProgramOnDevice, SaysSoWhenTheCpuStandsIn) {
    const RunResult run =
        isotet({"extract", "make:kuhn:8:gyroid", "-i", "0", "--device", test_device(), "--precision", "double", "-v"});
    EXPECT_EQ(run.status, 0);
    EXPECT_NE(run.err.find(
                  "note: the grid was packed in double precision, but the vulkan engine takes single precision only: "
                  "the CPU extracts instead"),
              std::string::npos)
        << run.err;
    EXPECT_NE(run.out.find("engine  cpu"), std::string::npos) << run.out;
}

TEST_F(ProgramOnDevice, RefusesWhatCannotBe) {
    const auto extract = [](std::vector<std::string> more) {
        more.insert(more.begin(), {"extract", "make:kuhn:8:gyroid", "-i", "0"});
        return isotet(more);
    };
    RunResult run = extract({"--engine", "vulkan", "--device", test_device(), "--precision", "double"});
    EXPECT_EQ(run.status, 2);
    EXPECT_TRUE(is_one_error(run, "packed in double precision"));
    run = extract({"--engine", "vulkan", "--device", "none"});
    EXPECT_EQ(run.status, 2);
    EXPECT_TRUE(is_one_error(run, "--engine vulkan needs a device"));
    run = extract({"--engine", "cpu", "--device", test_device()});
    EXPECT_EQ(run.status, 2);
    EXPECT_TRUE(is_one_error(run, "only --engine vulkan and auto use one"));
    run = extract({"--engine", "vulkan", "--device", test_device(), "--device-memory", "8kB"});
    EXPECT_EQ(run.status, 4);
    EXPECT_TRUE(is_one_error(run, "of device memory at least"));
}

} // namespace
} // namespace isotet::test
