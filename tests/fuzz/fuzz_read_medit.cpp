// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "fuzz/read_input.hpp"
#include "io/medit/read_medit.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace isotet;
    const auto [mesh, solution] = test::two_files(test::as_text(data, size));
    const auto result = io::parse_medit(mesh, solution, {}, {});
    test::expect_consistent(result);
    test::expect_same_fields(io::inspect_medit(mesh, solution, {}), result);
    return 0;
}
