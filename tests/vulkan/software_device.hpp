// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The device that tests run on: Mesa's software device unless another is named, watched by the validation layer.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "vulkan/context.hpp"
#include "vulkan/recorder.hpp"

namespace isotet::test {

/// The software device, or the one that ISOTET_TEST_DEVICE names.
const char* test_device();

/// Settings for tests: watched by the validation layer unless ISOTET_TEST_WATCH is 0, no files of compiled pipelines, waits of at
/// most 30 s.
vulkan::Settings watched();

/// Opens the test device; a failure of the test, with the reason, when there is none that can be trusted.
std::shared_ptr<vulkan::Context> open_software(const vulkan::Settings& settings = watched(),
                                               std::uint64_t memory_limit = 0);

/// A test with a device, which fails when the validation layer has something to say, be it that something was not given
/// back.
class OnDevice : public testing::Test {
protected:
    void SetUp() override { reopen(watched()); }
    void TearDown() override { close(); }

    /// The device with other settings; buffers of the old one must be gone.
    void reopen(const vulkan::Settings& settings, std::uint64_t memory_limit = 0);
    void close();

    vulkan::Context& context() { return *context_; }
    const std::shared_ptr<vulkan::Context>& shared_context() { return context_; }

    vulkan::Buffer take(std::uint64_t bytes, vulkan::Where where = vulkan::Where::device);
    vulkan::Buffer upload(std::span<const std::uint32_t> words);
    std::vector<std::uint32_t> download(const vulkan::Buffer& buffer);

private:
    std::shared_ptr<vulkan::Context> context_;
};

/// 0, 1, 2, ... times `step`.
std::vector<std::uint32_t> ramp(std::size_t count, std::uint32_t step = 1);

} // namespace isotet::test
