// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// `isotet docs`: man page, completions, docs/command-line.md and the page of Python's html(), for builds and for a test.
#include <algorithm>

#include <fmt/format.h>

#include "options/command_text.hpp"
#include "commands.hpp"
#include "output/standard_streams.hpp"
#include "view/export/saved_grid.hpp"

namespace isotet::cli {

Result<ExitCode> run_docs(const DocsCommand& command, const std::vector<CommandText>& commands) {
    std::string text;
    if (command.kind == "man" && !command.topic.empty()) {
        const auto topic = std::ranges::find(commands, command.topic, &CommandText::word);
        if (topic == commands.end()) return usage_error("docs man got '{}', which is no command", command.topic);
        text = man_page_of(*topic);
    } else if (command.kind == "man") text = man_page(commands);
    else if (command.kind == "bash") text = bash_completion(commands);
    else if (command.kind == "fish") text = fish_completion(commands);
    else if (command.kind == "zsh") text = zsh_completion(commands);
    else if (command.kind == "markdown") text = markdown(commands);
    else if (command.kind == "page") {
        const Result<std::string> page = view::unfilled_page();
        if (!page) return page.error();
        text = *page;
    } else {
        return usage_error("docs got '{}', but it takes man, bash, fish, zsh, markdown or page", command.kind);
    }
    if (Result<void> written = write_to_stdout(text); !written) return written.error();
    return ExitCode::done;
}

} // namespace isotet::cli
