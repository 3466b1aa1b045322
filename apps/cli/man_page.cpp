// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The man page, from the walk over the option tree.
#include <string_view>

#include <fmt/format.h>

#include <isotet/version.hpp>

#include "command_text.hpp"

namespace isotet::cli {

namespace {

/// Text that roff prints as it is: backslashes, minus signs that can be searched for, no accidental requests.
std::string roff(std::string_view text) {
    std::string result;
    for (const char c : text) {
        if (c == '\\') result += "\\e";
        else if (c == '-') result += "\\-";
        else if ((c == '.' || c == '\'') && (result.empty() || result.back() == '\n')) result += std::string("\\&") + c;
        else result += c;
    }
    return result;
}

std::string man_details(const std::string& text) {
    std::string result;
    for (const Paragraph& paragraph : paragraphs(text)) {
        result += paragraph.preformatted ? ".RS 4\n.nf\n" + roff(paragraph.text) + ".fi\n.RE\n"
                                         : ".PP\n" + roff(paragraph.text) + "\n";
    }
    return result;
}

std::string man_options(const CommandText& command) {
    std::string result;
    for (const OptionText& option : command.options) {
        const bool with_value = !option.positional && !option.value.empty();
        result += fmt::format(".TP\n\\fB{}\\fR{}\n{}\n", roff(option.names),
                              with_value ? " \\fI" + roff(option.value) + "\\fR" : "", roff(option.description));
    }
    return result;
}

} // namespace

std::string man_page(const std::vector<CommandText>& commands) {
    std::string text = ".TH ISOTET 1 \"\" \"isotet " ISOTET_VERSION "\" \"User Commands\"\n";
    const CommandText& program = commands.front();
    text += ".SH NAME\nisotet \\- " + roff(program.summary) + "\n.SH SYNOPSIS\n";
    for (const CommandText& command : commands) text += ".B " + roff(command.usage) + "\n.br\n";
    text +=
        ".SH DESCRIPTION\n" + man_details(program.details) + ".SH OPTIONS\n" + man_options(program) + ".SH COMMANDS\n";
    for (const CommandText& command : commands) {
        if (command.word.empty()) continue;
        text += ".SS " + roff(command.usage) + "\n" + roff(command.summary) + ".\n" + man_options(command) +
                man_details(command.details);
    }
    return text;
}

} // namespace isotet::cli
