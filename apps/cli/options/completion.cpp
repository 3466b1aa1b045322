// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Completion for bash, from the walk over the option tree.
#include <fmt/format.h>

#include "options/command_text.hpp"

namespace isotet::cli {

namespace {

template <class Strings>
std::string joined(const Strings& strings) {
    std::string result;
    for (const std::string& text : strings) result += (result.empty() ? "" : " ") + text;
    return result;
}

/// The case of one command: what may follow each option that takes a value, then the names of all options.
std::string command_case(const CommandText& command) {
    std::string values;
    std::vector<std::string> flags;
    for (const OptionText& option : command.options) {
        flags.insert(flags.end(), option.flags.begin(), option.flags.end());
        if (option.positional || option.value.empty()) continue;
        std::string pattern;
        for (const std::string& flag : option.flags) pattern += (pattern.empty() ? "" : "|") + flag;
        const std::string reply = option.is_file ? "_isotet_reply -f; "
                                  : option.choices.empty()
                                      ? ""
                                      : fmt::format("_isotet_reply -W \"{}\"; ", joined(option.choices));
        values += fmt::format("        {}) {}return ;;\n", pattern, reply);
    }
    return fmt::format("    {})\n        case \"$previous\" in\n{}        esac\n        flags=\"{}\" ;;\n",
                       command.word, values, joined(flags));
}

} // namespace

std::string bash_completion(const std::vector<CommandText>& commands) {
    std::vector<std::string> words;
    for (const CommandText& command : commands) {
        if (!command.word.empty()) words.push_back(command.word);
    }
    std::vector<std::string> program_flags;
    for (const OptionText& option : commands.front().options) {
        program_flags.insert(program_flags.end(), option.flags.begin(), option.flags.end());
    }
    // mapfile keeps names with spaces whole.
    std::string text =
        "# bash completion for isotet\n"
        "_isotet_reply() {\n"
        "    mapfile -t COMPREPLY < <(compgen \"$@\" -- \"${COMP_WORDS[COMP_CWORD]}\")\n"
        "}\n"
        "_isotet() {\n"
        "    local word=\"${COMP_WORDS[COMP_CWORD]}\" previous=\"${COMP_WORDS[COMP_CWORD-1]}\" flags=\"\"\n"
        "    COMPREPLY=()\n"
        "    if [ \"$COMP_CWORD\" -eq 1 ]; then\n";
    text += fmt::format("        _isotet_reply -f -W \"{} {}\"\n        return\n    fi\n", joined(words),
                        joined(program_flags));
    text += "    case \"${COMP_WORDS[1]}\" in\n";
    for (const CommandText& command : commands) {
        if (!command.word.empty()) text += command_case(command);
    }
    text += "    esac\n"
            "    case \"$word\" in\n"
            "    -*) _isotet_reply -W \"$flags\" ;;\n"
            "    *) _isotet_reply -f ;;\n"
            "    esac\n"
            "}\n"
            "complete -o filenames -F _isotet isotet\n";
    return text;
}

} // namespace isotet::cli
