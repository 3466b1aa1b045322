// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "fuzz/read_input.hpp"
#include "io/gmsh/read_gmsh.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace isotet;
    const std::string_view bytes = test::as_text(data, size);
    const auto result = io::parse_gmsh(bytes, {}, {});
    test::expect_consistent(result);
    test::expect_same_fields(io::inspect_gmsh(bytes, {}), result);
    return 0;
}
