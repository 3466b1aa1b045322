// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The tests' main function: also the reader process in which VTK's readers run.
#include <gtest/gtest.h>

#include <isotet/read.hpp>

int main(int argc, char** argv) {
    if (const auto status = isotet::run_as_reader(argc, argv)) return *status;
    testing::InitGoogleTest(&argc, argv);
    return RUN_ALL_TESTS();
}
