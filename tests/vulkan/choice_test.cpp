// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// --device: which device is meant, and what is said when none or several are.
#include <vector>

#include <gtest/gtest.h>

#include "vulkan/devices/choice.hpp"

namespace isotet::test {
namespace {

DeviceInfo device(std::string name, DeviceKind kind, std::uint64_t memory = 1000, std::string unusable = {}) {
    DeviceInfo info;
    info.name = std::move(name);
    info.kind = kind;
    info.memory = memory;
    info.unusable = std::move(unusable);
    return info;
}

class Choosing : public testing::Test {
protected:
    void SetUp() override {
        for (std::size_t i = 0; i < devices.size(); ++i) devices[i].index = i;
    }
    std::string chosen(std::string_view choice) const {
        const auto found = vulkan::choose(devices, choice);
        return found ? devices[*found].name : found.error().message;
    }
    ErrorCode code(std::string_view choice) const { return vulkan::choose(devices, choice).error().code; }

    std::vector<DeviceInfo> devices = {
        device("llvmpipe (LLVM 15)", DeviceKind::software, 99999),
        device("Intel Arc A770", DeviceKind::discrete, 16000),
        device("Intel UHD 770", DeviceKind::integrated, 60000),
        device("NVIDIA RTX 4090", DeviceKind::discrete, 24000),
        device("NVIDIA Quadro 600", DeviceKind::discrete, 30000, "it has Vulkan 1.0.3, but 1.1 is needed"),
    };
};

TEST_F(Choosing, TakesTheDiscreteDeviceWithTheMostMemoryThatCanBeUsed) {
    EXPECT_EQ(chosen(""), "NVIDIA RTX 4090");
    devices.erase(devices.begin() + 3);
    EXPECT_EQ(chosen(""), "Intel Arc A770");
    devices.erase(devices.begin() + 1);
    EXPECT_EQ(chosen(""), "Intel UHD 770");
}

TEST_F(Choosing, NeverTakesASoftwareDeviceUnasked) {
    devices.resize(1);
    EXPECT_EQ(chosen(""), "no graphics card that can be used; devices: 0: llvmpipe (LLVM 15) (software)");
    EXPECT_EQ(code(""), ErrorCode::no_device);
    EXPECT_EQ(chosen("software"), "llvmpipe (LLVM 15)");
}

TEST_F(Choosing, TakesAnIndex) {
    EXPECT_EQ(chosen("2"), "Intel UHD 770");
    EXPECT_EQ(code("5"), ErrorCode::invalid_argument);
    EXPECT_EQ(chosen("5").substr(0, 27), "there is no Vulkan device 5");
    EXPECT_EQ(code("18446744073709551616"), ErrorCode::invalid_argument);
}

TEST_F(Choosing, TakesAPartOfANameInAnyCase) {
    EXPECT_EQ(chosen("arc"), "Intel Arc A770");
    EXPECT_EQ(chosen("uHd"), "Intel UHD 770");
    EXPECT_EQ(code("amd"), ErrorCode::invalid_argument);
    EXPECT_EQ(chosen("amd").substr(0, 35), "no Vulkan device is called 'amd'; d");
}

TEST_F(Choosing, RefusesAPartThatFitsSeveral) {
    EXPECT_EQ(code("intel"), ErrorCode::invalid_argument);
    EXPECT_EQ(chosen("intel").substr(0, 44), "'intel' fits more than one Vulkan device; de");
    EXPECT_EQ(chosen("nvidia"), "NVIDIA RTX 4090") << "the only one of these that can be used";
}

TEST_F(Choosing, SaysWhyTheDeviceThatWasNamedCannotBeUsed) {
    const std::string why = "the device NVIDIA Quadro 600 cannot be used: it has Vulkan 1.0.3, but 1.1 is needed";
    EXPECT_EQ(chosen("quadro"), why);
    EXPECT_EQ(chosen("4"), why);
    EXPECT_EQ(code("4"), ErrorCode::no_device);
}

TEST_F(Choosing, SaysWhatThereIs) {
    EXPECT_NE(chosen("amd").find("4: NVIDIA Quadro 600 (discrete GPU; cannot be used: it has Vulkan 1.0.3"),
              std::string::npos);
    devices.clear();
    EXPECT_EQ(chosen("software"), "no Vulkan device is called 'software'; devices: there is none");
    EXPECT_EQ(chosen(""), "no graphics card that can be used; devices: there is none");
}

} // namespace
} // namespace isotet::test
