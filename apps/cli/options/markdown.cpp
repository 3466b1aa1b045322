// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// docs/command-line.md, from the walk over the option tree.
#include <algorithm>
#include <map>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "options/command_text.hpp"

namespace isotet::cli {

namespace {

std::string list_item(const OptionText& option) {
    const bool with_value = !option.positional && !option.value.empty();
    return fmt::format("- `{}`: {}\n", option.names + (with_value ? " " + option.value : ""), option.description);
}

/// The first command that has an option with this item, by the item: the page tells the option there.
using FirstCommands = std::map<std::string, const CommandText*>;

FirstCommands first_commands(const std::vector<CommandText>& commands) {
    FirstCommands first;
    for (const CommandText& command : commands) {
        for (const OptionText& option : command.options) first.emplace(list_item(option), &command);
    }
    return first;
}

/// "isotet extract" to "isotet-extract".
std::string anchor_of(std::string name) {
    std::ranges::replace(name, ' ', '-');
    return name;
}

/// The options that a command shares with earlier ones, one line an earlier command.
std::string markdown_shared_options(const CommandText& command, const std::vector<CommandText>& commands,
                                    const FirstCommands& first) {
    std::string result;
    for (const CommandText& earlier : commands) {
        if (&earlier == &command) break;
        if (earlier.word.empty()) continue; // --help, which every command has
        std::vector<std::string> names;
        for (const OptionText& option : command.options) {
            if (first.at(list_item(option)) == &earlier)
                names.push_back("`" + (option.positional ? option.names : option.flags.back()) + "`");
        }
        if (!names.empty())
            result +=
                fmt::format("\nAs in [{}](#{}): {}\n", earlier.name, anchor_of(earlier.name), fmt::join(names, " "));
    }
    return result;
}

std::string markdown_options(const CommandText& command, const std::vector<CommandText>& commands,
                             const FirstCommands& first) {
    std::string items;
    for (const OptionText& option : command.options) {
        const std::string item = list_item(option);
        if (first.at(item) == &command) items += item;
    }
    return (items.empty() ? "" : "\n" + items) + markdown_shared_options(command, commands, first);
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
        "# Command line\n\nThis page is what `isotet docs markdown` prints; a test compares them. Options that "
        "several commands have are told with the first of them; every command has `--help`. The keys of `--json` are "
        "in [json.md](json.md).\n";
    const FirstCommands first = first_commands(commands);
    const std::string& program_details = commands.front().details;
    for (const CommandText& command : commands) {
        text += fmt::format("\n## {}\n\n{}.\n\n```\n{}\n```\n", command.name, command.summary, command.usage);
        text += markdown_options(command, commands, first);
        if (command.word.empty() || command.details != program_details) text += markdown_details(command.details);
    }
    return text;
}

} // namespace isotet::cli
