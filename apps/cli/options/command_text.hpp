// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The option tree as text, found by one walk over it, and what is printed of it: --help, man page, completions and
// markdown.
#pragma once

#include <string>
#include <vector>

namespace isotet::cli {

struct OptionText {
    std::string names;                ///< "-f, --field", or "FILE" for a positional
    std::vector<std::string> flags;   ///< "-f", "--field"; empty for a positional
    std::string value;                ///< "FIELD"; empty for a flag
    std::vector<std::string> choices; ///< "none", "gradient", "face"; those that are words as they stand
    std::string description;
    std::string group; ///< its heading in --help-all and man pages; positionals have the first
    bool positional = false, required = false, repeatable = false;
    bool is_file = false; ///< the value is a file's name
    bool rare = false;    ///< shown by --help-all alone
};

struct CommandText {
    std::string name;  ///< "isotet extract"; "isotet" for the program itself
    std::string word;  ///< "extract"; empty for the program itself
    std::string usage; ///< "isotet extract [OPTIONS] FILE [OUT]"
    std::string summary;
    std::string details; ///< paragraphs between empty lines; lines that begin with two spaces are kept as they are
    std::vector<OptionText> options; ///< positionals first
};

/// One piece of CommandText::details.
struct Paragraph {
    bool preformatted = false;
    std::string text; ///< preformatted: lines without their two spaces, each with its newline
};
std::vector<Paragraph> paragraphs(const std::string& details);

/// Positionals first, then each group together, in the order of the first of each.
std::vector<OptionText> by_groups(const std::vector<OptionText>& options);

enum class Help { common, all };

std::string help_text(const CommandText& command, const std::vector<CommandText>& commands, Help help);
std::string man_page(const std::vector<CommandText>& commands);
std::string man_page_of(const CommandText& command);
std::string bash_completion(const std::vector<CommandText>& commands);
std::string fish_completion(const std::vector<CommandText>& commands);
std::string zsh_completion(const std::vector<CommandText>& commands);
std::string markdown(const std::vector<CommandText>& commands);

} // namespace isotet::cli
