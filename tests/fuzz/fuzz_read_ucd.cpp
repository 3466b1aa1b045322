// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "fuzz/read_input.hpp"
#include "io/ucd/read_ucd.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace isotet;
    const auto result = io::parse_ucd(test::as_text(data, size), {}, {});
    test::expect_consistent(result);
    return 0;
}
