// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Any bytes, as a message of a page and as a pasted command line: an error with a sentence, or a state that is written and
// read back, whose command line, pasted, has the same command line.
#include <cstdlib>
#include <string>

#include "fuzz/read_input.hpp"
#include "view/command_line.hpp"
#include "view/messages.hpp"

namespace {

using namespace isotet::view;

void check_state(const ViewState& state) {
    const std::string text = text_of(to_json(state));
    const auto json = parse_json(text);
    if (!json) std::abort();
    const auto back = state_of(*json);
    if (!back || text_of(to_json(*back)) != text) std::abort();
    const auto words = render_words(state, "grid.vtu");
    const auto command = state_of_command(shell_text(words));
    if (!command || render_words(command->state, "grid.vtu") != words) std::abort();
}

void check_error(const isotet::Error& error) {
    if (error.message.empty() || error.code == isotet::ErrorCode::internal) std::abort();
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto text = isotet::test::as_text(data, size);
    const auto message = parse_page_message(text);
    if (!message) check_error(message.error());
    else if (const auto* show = std::get_if<ShowMessage>(&*message)) check_state(show->state);
    const auto pasted = state_of_command(text);
    if (!pasted) check_error(pasted.error());
    else check_state(pasted->state);
    return 0;
}
