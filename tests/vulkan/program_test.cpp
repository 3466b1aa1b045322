// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// `isotet devices`, with a device, without one, and without Vulkan on the machine.
#include "cli/program.hpp"

namespace isotet::test {
namespace {

TEST(DevicesCommand, ListsTheSoftwareDevice) {
    const auto report = json_of({"devices"});
    EXPECT_EQ(report["command"], "devices");
    EXPECT_TRUE(report["unavailable"].is_null());
    ASSERT_GE(report["devices"].size(), 1u);
    const auto& device = report["devices"][report["devices"].size() - 1];
    EXPECT_EQ(device["kind"], "software");
    EXPECT_TRUE(device["unusable"].is_null()) << device["unusable"];
    EXPECT_NE(report["best"], device["index"]) << "never without being asked for";
    EXPECT_GT(device["memory"], 1e8);
    EXPECT_EQ(device["workgroups"].size(), 3u);
    EXPECT_TRUE(report["exact"].is_null()) << "not opened";
    EXPECT_NE(isotet({"devices"}).out.find("used only by --device software"), std::string::npos);
}

TEST(DevicesCommand, TestsTheDeviceThatIsChosen) {
    const auto report = json_of({"devices", "--device", "software"});
    EXPECT_EQ(report["exact"], true);
    EXPECT_EQ(report["devices"].size(), 1u);
    EXPECT_EQ(report["devices"][0]["name"], json_of({"devices", "--device", "LLVMpipe"})["devices"][0]["name"]);
    EXPECT_NE(isotet({"devices", "--device", "software"}).out.find("arithmetic      exact"), std::string::npos);
}

TEST(DevicesCommand, RefusesDevicesThatAreNotThere) {
    const RunResult none = isotet({"devices", "--device", "none"}), wrong = isotet({"devices", "--device", "Voodoo"});
    EXPECT_EQ(none.status, 2);
    EXPECT_TRUE(is_one_error(none, "--device none is no device"));
    EXPECT_EQ(wrong.status, 2);
    EXPECT_TRUE(is_one_error(wrong, "no Vulkan device is called 'Voodoo'; devices: 0: llvmpipe"));
}

/// A machine without a driver for Vulkan.
const RunOptions no_driver = {
    .environment = {{"VK_DRIVER_FILES", "/nonexistent.json"}, {"VK_ICD_FILENAMES", "/nonexistent.json"}}};

TEST(DevicesCommand, SaysThatThereIsNoDriver) {
    const RunResult run = isotet({"devices"}, no_driver);
    EXPECT_EQ(run.status, 0);
    EXPECT_EQ(run.out, "");
    EXPECT_TRUE(is_one_error(run, "note: there is a Vulkan loader on this machine, but no driver that it can use; "));
    EXPECT_TRUE(is_one_error(run, "mesa-vulkan-drivers of Debian and Ubuntu has a software device; isotet works on"));
    const RunResult chosen = isotet({"devices", "--device", "software"}, no_driver);
    EXPECT_EQ(chosen.status, 4);
    EXPECT_TRUE(is_one_error(chosen, "no driver that it can use"));
}

TEST_F(Program, IsNotStoppedByABrokenDescriptionOfADriver) {
    put_content(path("broken.json"), "{ \"file_format_version\": ");
    const RunResult run =
        isotet({"devices"},
               {.environment = {{"VK_DRIVER_FILES", path("broken.json")}, {"VK_ICD_FILENAMES", path("broken.json")}}});
    EXPECT_EQ(run.status, 0);
    EXPECT_EQ(run.out, "");
    EXPECT_TRUE(run.err.starts_with("isotet: note: ") && run.err.ends_with("; isotet works on the CPU\n")) << run.err;
}

TEST(DevicesCommand, FindsExactArithmeticAtAnySubgroupSize) {
    for (const auto& [bits, size] : {std::pair{"128", 4}, {"256", 8}, {"512", 16}}) {
        const RunResult run = isotet({"devices", "--device", "software", "--json", "-"},
                                     {.environment = {{"LP_NATIVE_VECTOR_WIDTH", bits}}});
        ASSERT_EQ(run.status, 0) << run.err;
        const auto report = nlohmann::json::parse(run.out);
        EXPECT_EQ(report["devices"][0]["subgroup_size"], size);
        EXPECT_EQ(report["exact"], true) << size;
    }
}

/// A machine without Vulkan: a library of the loader's name that is none comes first.
class WithoutVulkan : public Program {
protected:
    void SetUp() override { put_content(path("libvulkan.so.1"), ""); }
    RunResult run(std::vector<std::string> arguments) const {
        return isotet(std::move(arguments), {.environment = {{"LD_LIBRARY_PATH", folder.path().string()}}});
    }
};

TEST_F(WithoutVulkan, TheProgramSaysSoAndWorksOnTheProcessor) {
    const RunResult devices = run({"devices"});
    EXPECT_EQ(devices.status, 0);
    EXPECT_NE(devices.err.find("there is no Vulkan on this machine: "), std::string::npos) << devices.err;
    EXPECT_NE(devices.err.find("; isotet works on the CPU"), std::string::npos) << devices.err;
    const RunResult extract = run({"extract", "make:kuhn:4:sphere", path("sphere.vtp"), "-i", "0.5"});
    EXPECT_EQ(extract.status, 0) << extract.err;
    EXPECT_GT(content_of(path("sphere.vtp")).size(), 1000u);
}

TEST_F(WithoutVulkan, ADeviceThatIsAskedForIsAnError) {
    const RunResult chosen = run({"devices", "--device", "0"});
    EXPECT_EQ(chosen.status, 4);
    EXPECT_TRUE(is_one_error(chosen, "there is no Vulkan on this machine"));
}

} // namespace
} // namespace isotet::test
