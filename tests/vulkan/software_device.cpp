// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "vulkan/software_device.hpp"

#include <cstdlib>
#include <stdexcept>
#include <string>

namespace isotet::test {

namespace {

std::string environment(const char* name, const char* otherwise) {
    const char* value = std::getenv(name);
    return value ? value : otherwise;
}

} // namespace

const char* test_device() {
    static const std::string device = environment("ISOTET_TEST_DEVICE", "software");
    return device.c_str();
}

vulkan::Settings watched() {
    const bool is_watched = environment("ISOTET_TEST_WATCH", "1") != "0";
    vulkan::Settings settings;
    settings.watch = {is_watched ? vulkan::Validation::on : vulkan::Validation::off,
                      std::make_shared<vulkan::Complaints>()};
    settings.wait_limit = std::chrono::seconds(30);
    settings.cache_folder = std::filesystem::path();
    return settings;
}

std::shared_ptr<vulkan::Context> open_software(const vulkan::Settings& settings, std::uint64_t memory_limit) {
    auto context = vulkan::Context::open({test_device(), memory_limit}, settings);
    if (context) return *context;
    throw std::runtime_error("these tests need Mesa's software device, version 25 or later, and the Khronos validation "
                             "layer: run scripts/test.sh, or source build/test/mesa/env.sh first. " +
                             context.error().message);
}

void OnDevice::reopen(const vulkan::Settings& settings, std::uint64_t memory_limit) {
    close();
    context_ = open_software(settings, memory_limit);
    EXPECT_EQ(context_->notices(), std::vector<std::string>());
}

void OnDevice::close() {
    if (!context_) return;
    const std::shared_ptr<vulkan::Complaints> complaints = context_->settings().watch.complaints;
    ASSERT_EQ(context_.use_count(), 1);
    context_.reset();
    for (const std::string& complaint : complaints->all()) ADD_FAILURE() << complaint;
}

vulkan::Buffer OnDevice::take(std::uint64_t bytes, vulkan::Where where) {
    return context().memory().take(bytes, where, "a test's").value();
}

vulkan::Buffer OnDevice::upload(std::span<const std::uint32_t> words) {
    vulkan::Buffer buffer = take(words.size_bytes());
    context().staging().upload(buffer, 0, std::as_bytes(words)).value();
    return buffer;
}

std::vector<std::uint32_t> OnDevice::download(const vulkan::Buffer& buffer) {
    std::vector<std::uint32_t> words(buffer.size() / sizeof(std::uint32_t));
    context().staging().download(buffer, 0, std::as_writable_bytes(std::span(words))).value();
    return words;
}

std::vector<std::uint32_t> ramp(std::size_t count, std::uint32_t step) {
    std::vector<std::uint32_t> words(count);
    for (std::size_t i = 0; i < count; ++i) words[i] = static_cast<std::uint32_t>(i) * step;
    return words;
}

} // namespace isotet::test
