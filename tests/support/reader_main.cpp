// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The main function of tests that read through VTK: also the reader process that they start.
#include <gtest/gtest.h>

#include <isotet/read.hpp>

int main(int argc, char** argv) {
    if (const auto status = isotet::run_as_reader(argc, argv)) return *status;
    testing::InitGoogleTest(&argc, argv);
    return RUN_ALL_TESTS();
}
