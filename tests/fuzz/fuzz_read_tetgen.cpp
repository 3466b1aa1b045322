// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "fuzz/read_input.hpp"
#include "io/tetgen/read_tetgen.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace isotet;
    const auto [nodes, elements] = test::two_files(test::as_text(data, size));
    const auto result = io::parse_tetgen(nodes, elements.value_or(""), {}, {});
    test::expect_consistent(result);
    test::expect_same_fields(io::inspect_tetgen(nodes, elements.value_or(""), {}), result);
    return 0;
}
