// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// docs/command-line.md, from the walk over the option tree.
#include <string_view>

#include <fmt/format.h>

#include "command_text.hpp"

namespace isotet::cli {

namespace {

std::string in_table(std::string_view text) {
    std::string result;
    for (const char c : text) {
        if (c == '|') result += '\\';
        result += c;
    }
    return result;
}

std::string markdown_options(const CommandText& command) {
    std::string result = "| option | |\n|---|---|\n";
    for (const OptionText& option : command.options) {
        const bool with_value = !option.positional && !option.value.empty();
        result += fmt::format("| `{}` | {} |\n", in_table(option.names + (with_value ? " " + option.value : "")),
                              in_table(option.description));
    }
    return result;
}

std::string markdown_details(const std::string& text) {
    std::string result;
    for (const Paragraph& paragraph : paragraphs(text)) {
        result += paragraph.preformatted ? "\n```\n" + paragraph.text + "```\n" : "\n" + paragraph.text + "\n";
    }
    return result;
}

} // namespace

std::string markdown(const std::vector<CommandText>& commands) {
    std::string text =
        "# Command line\n\nThis page is what `isotet docs markdown` prints; a test compares them. The keys of "
        "`--json` are in [json.md](json.md).\n";
    for (const CommandText& command : commands) {
        text += fmt::format("\n## {}\n\n{}.\n\n```\n{}\n```\n\n", command.name, command.summary, command.usage);
        text += markdown_options(command) + markdown_details(command.details);
    }
    return text;
}

} // namespace isotet::cli
