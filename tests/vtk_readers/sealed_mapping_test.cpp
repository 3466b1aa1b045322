// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Memory files that are sealed and mapped, on kernels of any age.
#include <cinttypes>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <string>

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <gtest/gtest.h>

#include "base/system/descriptor.hpp"
#include "base/system/sealed_mapping.hpp"

namespace isotet::test {
namespace {

using core::Descriptor;
using core::map_sealed;

Descriptor memory_file(const std::string& content) {
    Descriptor file(::memfd_create("isotet-test", MFD_CLOEXEC | MFD_ALLOW_SEALING));
    EXPECT_EQ(::pwrite(file.number(), content.data(), content.size(), 0), static_cast<ssize_t>(content.size()));
    return file;
}

/// How /proc/self/maps describes the mapping at an address: "r--p".
std::string permissions_at(const void* address) {
    const auto wanted = reinterpret_cast<std::uintptr_t>(address);
    std::ifstream maps("/proc/self/maps");
    for (std::string line; std::getline(maps, line);) {
        std::uintptr_t begin = 0, end = 0;
        char permissions[5] = {};
        if (std::sscanf(line.c_str(), "%" SCNxPTR "-%" SCNxPTR " %4s", &begin, &end, permissions) == 3 &&
            begin <= wanted && wanted < end)
            return permissions;
    }
    return "not mapped";
}

TEST(SealedMapping, IsPrivateAndReadOnly) {
    const Descriptor file = memory_file("some bytes");
    const auto mapping = map_sealed(file.number());
    ASSERT_TRUE(mapping) << mapping.error().message;
    EXPECT_EQ(permissions_at(mapping->bytes.data()), "r--p");
}

TEST(SealedMapping, HoldsWhatCannotBeChangedAnyMore) {
    Descriptor file = memory_file("some bytes");
    auto mapping = map_sealed(file.number());
    ASSERT_TRUE(mapping) << mapping.error().message;
    EXPECT_LT(::pwrite(file.number(), "S", 1, 0), 0);
    EXPECT_NE(::ftruncate(file.number(), 3), 0);
    EXPECT_NE(::ftruncate(file.number(), 30), 0);
    file.reset();
    EXPECT_EQ(std::string(reinterpret_cast<const char*>(mapping->bytes.data()), mapping->bytes.size()), "some bytes");
    const void* const begin = mapping->bytes.data();
    mapping->owner.reset();
    EXPECT_EQ(permissions_at(begin), "not mapped");
}

TEST(SealedMapping, OfAnEmptyFileIsEmpty) {
    const Descriptor file = memory_file("");
    const auto mapping = map_sealed(file.number());
    ASSERT_TRUE(mapping) << mapping.error().message;
    EXPECT_TRUE(mapping->bytes.empty());
}

TEST(SealedMapping, OfAFileThatSomebodyMayStillWriteIsRefused) {
    const Descriptor file = memory_file(std::string(4096, 'x'));
    void* const writable = ::mmap(nullptr, 4096, PROT_READ | PROT_WRITE, MAP_SHARED, file.number(), 0);
    ASSERT_NE(writable, MAP_FAILED);
    const auto mapping = map_sealed(file.number());
    ASSERT_FALSE(mapping);
    EXPECT_EQ(mapping.error().code, ErrorCode::system);
    EXPECT_NE(mapping.error().message.find("cannot be sealed"), std::string::npos) << mapping.error().message;
    ::munmap(writable, 4096);
}

} // namespace
} // namespace isotet::test
