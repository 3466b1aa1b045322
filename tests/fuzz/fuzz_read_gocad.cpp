// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "fuzz/read_input.hpp"
#include "io/gocad/read_gocad.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace isotet;
    const std::string_view text = test::as_text(data, size);
    const auto result = io::parse_gocad(text, {}, {});
    test::expect_consistent(result);
    test::expect_same_fields(io::inspect_gocad(text, {}), result);
    return 0;
}
