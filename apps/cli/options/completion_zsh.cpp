// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Completion for zsh, from the walk over the option tree.
#include <string_view>

#include <fmt/format.h>

#include "options/command_text.hpp"

namespace isotet::cli {

namespace {

/// For single quotes, with a backslash before each of `special`.
std::string escaped(const std::string& text, std::string_view special) {
    std::string out;
    for (const char c : text) {
        if (special.find(c) != std::string_view::npos) out += '\\';
        out += c == '\'' ? "'\\''" : std::string(1, c);
    }
    return out;
}

/// What _arguments completes a value by.
std::string action_of(const OptionText& option) {
    if (option.is_file) return "_files";
    return option.choices.empty() ? " " : fmt::format("({})", fmt::join(option.choices, " "));
}

/// As _arguments takes it: '(-f --field)'{-f,--field}'[The field to contour]:FIELD: '.
std::string argument(const OptionText& option) {
    const bool several = option.flags.size() > 1;
    std::string names = several ? fmt::format("{{{}}}", fmt::join(option.flags, ",")) : option.flags.front();
    if (option.repeatable) names = "'*'" + names;
    else if (several) names = fmt::format("'({})'{}", fmt::join(option.flags, " "), names);
    const std::string value =
        option.value.empty() ? "" : fmt::format(":{}:{}", escaped(option.value, ":\\"), action_of(option));
    return fmt::format("{}'[{}]{}'", names, escaped(option.description, "[]\\"), value);
}

std::string arguments(const CommandText& command) {
    std::string text = "_arguments -s -S";
    for (const OptionText& option : command.options)
        if (!option.positional) text += " \\\n            " + argument(option);
    return text + " \\\n            '*:file:_files'";
}

} // namespace

std::string zsh_completion(const std::vector<CommandText>& commands) {
    std::string words, cases;
    for (const CommandText& command : commands) {
        if (command.word.empty()) continue;
        words += fmt::format("            '{}:{}'\n", command.word, escaped(command.summary, ":\\"));
        cases += fmt::format("        {})\n            {} ;;\n", command.word, arguments(command));
    }
    return fmt::format("#compdef isotet\n"
                       "_isotet() {{\n"
                       "    if (( CURRENT == 2 )); then\n"
                       "        local -a commands=(\n{}        )\n"
                       "        _describe command commands\n"
                       "        _files\n"
                       "        return\n"
                       "    fi\n"
                       "    local command=$words[2]\n"
                       "    shift words\n"
                       "    (( CURRENT-- ))\n"
                       "    case $command in\n{}    esac\n"
                       "}}\n"
                       "_isotet \"$@\"\n",
                       words, cases);
}

} // namespace isotet::cli
