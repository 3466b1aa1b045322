// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Reads the grid of a file through isotet-reader, a program that it does not name.
#include <cstdio>

#include <isotet/read.hpp>

int main(int, char** argv) {
    const auto result = isotet::read(argv[1]);
    if (!result) std::printf("%s\n", result.error().message.c_str());
    return result && result->grid.cells.count() > 0 ? 0 : 1;
}
