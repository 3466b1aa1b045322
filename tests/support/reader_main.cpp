// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The main function of tests that read by isotet-reader: it is found in PATH.
#include <cstdlib>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "support/places.hpp"

int main(int argc, char** argv) {
    const char* const path = std::getenv("PATH");
    const std::string folder = std::filesystem::path(isotet::test::reader_path()).parent_path().string();
    ::setenv("PATH", (folder + ":" + (path ? path : "")).c_str(), 1);
    testing::InitGoogleTest(&argc, argv);
    return RUN_ALL_TESTS();
}
