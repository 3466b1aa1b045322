// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The man page, from the walk over the option tree.
#include <algorithm>
#include <string_view>

#include <fmt/format.h>

#include <isotet/version.hpp>

#include "options/command_text.hpp"

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

std::string upper(std::string text) {
    std::ranges::transform(text, text.begin(), [](char c) { return c >= 'a' && c <= 'z' ? char(c - 'a' + 'A') : c; });
    return text;
}

std::string man_options(const CommandText& command) {
    std::string result, heading = "Options";
    for (const OptionText& option : by_groups(command.options)) {
        if (option.group != heading) result += ".SS " + roff(heading = option.group) + "\n";
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
        text += fmt::format(".TP\n.BR isotet\\-{} (1)\n{}\n", roff(command.word), roff(command.summary));
    }
    return text;
}

std::string man_page_of(const CommandText& command) {
    return fmt::format(".TH ISOTET-{} 1 \"\" \"isotet " ISOTET_VERSION "\" \"User Commands\"\n", upper(command.word)) +
           fmt::format(".SH NAME\nisotet\\-{} \\- {}\n.SH SYNOPSIS\n.B {}\n.SH OPTIONS\n", roff(command.word),
                       roff(command.summary), roff(command.usage)) +
           man_options(command) + ".SH DESCRIPTION\n" + man_details(command.details) + ".SH SEE ALSO\n.BR isotet (1)\n";
}

} // namespace isotet::cli
