// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// --help, from the walk over the option tree.
#include <algorithm>

#include <fmt/format.h>

#include "options/command_text.hpp"
#include "output/text.hpp"

namespace isotet::cli {

namespace {

constexpr std::size_t columns = 100;
constexpr std::size_t description_column = 30;

std::string entry(const std::string& left, const std::string& description) {
    std::string line = fmt::format("  {}", left);
    if (line.size() + 2 > description_column) line += "\n" + std::string(description_column, ' ');
    else line.resize(description_column, ' ');
    return line + wrapped(description, columns, description_column) + "\n";
}

std::string entry(const OptionText& option) {
    const bool with_value = !option.positional && !option.value.empty();
    return entry(with_value ? fmt::format("{} {}", option.names, option.value) : option.names, option.description);
}

std::string details_text(const std::vector<Paragraph>& some) {
    std::string text;
    for (const Paragraph& paragraph : some) {
        if (!paragraph.preformatted) {
            text += fmt::format("\n{}\n", wrapped(paragraph.text, columns));
            continue;
        }
        for (std::size_t begin = 0; begin < paragraph.text.size();) {
            const std::size_t end = paragraph.text.find('\n', begin) + 1;
            text += fmt::format("  {}", paragraph.text.substr(begin, end - begin));
            begin = end;
        }
    }
    return text;
}

/// From the paragraph on that announces them.
std::vector<Paragraph> examples_of(const std::vector<Paragraph>& all) {
    return {std::ranges::find(all, "Examples:", &Paragraph::text), all.end()};
}

} // namespace

std::string help_text(const CommandText& command, const std::vector<CommandText>& commands, Help help) {
    std::string text = fmt::format("{}\n\nUsage: {}\n", command.summary, command.usage);
    if (command.word.empty()) {
        text += "\nCommands (isotet COMMAND --help says more):\n";
        for (const CommandText& other : commands) {
            if (!other.word.empty()) text += entry(other.word, other.summary);
        }
    }
    text += "\nOptions:\n";
    std::size_t left_out = 0;
    std::string heading = "Options";
    for (const OptionText& option : help == Help::all ? by_groups(command.options) : command.options) {
        if (option.rare && help == Help::common) {
            ++left_out;
            continue;
        }
        if (help == Help::all && option.group != heading) text += fmt::format("\n{}:\n", heading = option.group);
        text += entry(option);
    }
    const std::vector<Paragraph> details = paragraphs(command.details);
    if (left_out == 0) return text + details_text(details);
    text += fmt::format("\n{} more options, and details: {} --help-all\n", left_out, command.name);
    return text + details_text(examples_of(details));
}

} // namespace isotet::cli
