// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Completion for fish, from the walk over the option tree.
#include <fmt/format.h>

#include "options/command_text.hpp"

namespace isotet::cli {

namespace {

std::string quoted(const std::string& text) {
    std::string out = "'";
    for (const char c : text) {
        if (c == '\'' || c == '\\') out += '\\';
        out += c;
    }
    return out + "'";
}

/// One line: an option, told where `condition` holds.
std::string option_line(const OptionText& option, const std::string& condition) {
    std::string line = fmt::format("complete -c isotet -n {}", quoted(condition));
    for (const std::string& flag : option.flags)
        line += flag.starts_with("--") ? " -l " + flag.substr(2) : " -s " + flag.substr(1);
    if (option.is_file) line += " -r -F";
    else if (!option.choices.empty()) line += " -x -a " + quoted(fmt::format("{}", fmt::join(option.choices, " ")));
    else if (!option.value.empty()) line += " -x";
    return line + " -d " + quoted(option.description) + "\n";
}

} // namespace

std::string fish_completion(const std::vector<CommandText>& commands) {
    std::string text = "# fish completion for isotet\n";
    for (const CommandText& command : commands) {
        const bool is_program = command.word.empty();
        if (!is_program)
            text += fmt::format("complete -c isotet -n __fish_use_subcommand -a {} -d {}\n", command.word,
                                quoted(command.summary));
        const std::string condition =
            is_program ? "__fish_use_subcommand" : "__fish_seen_subcommand_from " + command.word;
        for (const OptionText& option : command.options)
            if (!option.positional) text += option_line(option, condition);
    }
    return text;
}

} // namespace isotet::cli
