// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// A deck, and one file that it may include under any name.
#include <algorithm>

#include "fuzz/read_input.hpp"
#include "io/grdecl/read_grdecl.hpp"

namespace {

/// Repeat counts make a large grid of few bytes, which takes its time, rightly.
bool has_large_repeat(std::string_view text) {
    constexpr std::size_t digits = 5;
    for (std::size_t star = text.find('*'); star != std::string_view::npos; star = text.find('*', star + 1)) {
        const std::string_view before = text.substr(star < digits ? 0 : star - digits, std::min(star, digits));
        if (before.size() == digits && before.find_first_not_of("0123456789") == std::string_view::npos) return true;
    }
    return false;
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace isotet;
    const auto [deck, included] = test::two_files(test::as_text(data, size));
    const auto open = [second = included](std::string_view name) -> Result<io::grdecl::DeckText> {
        if (!second) return Error{ErrorCode::file, "is not there"};
        return io::grdecl::DeckText{std::string(name), nullptr, *second};
    };
    if (has_large_repeat(deck) || (included && has_large_repeat(*included))) return 0;
    const io::grdecl::DeckText text{"deck", nullptr, deck};
    const auto result = io::parse_grdecl(text, open, {}, {});
    test::expect_consistent(result);
    test::expect_same_fields(io::inspect_grdecl(text, open, {}), result);
    return 0;
}
