// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "option_walker.hpp"

#include <string_view>

namespace isotet::cli {

namespace {

/// "OUT_FILE" is shown as "OUT": the ending only says that it is a file's name.
std::string shown_type(std::string type, bool& is_file) {
    constexpr std::string_view ending = "FILE";
    is_file = type.ends_with(ending);
    if (is_file && type.size() > ending.size()) type.resize(type.size() - ending.size() - 1);
    return type;
}

std::vector<std::string> split_at_bars(const std::string& type) {
    std::vector<std::string> words;
    if (type.find('|') == std::string::npos) return words;
    for (std::size_t begin = 0; begin <= type.size();) {
        const std::size_t end = std::min(type.find('|', begin), type.size());
        words.push_back(type.substr(begin, end - begin));
        begin = end + 1;
    }
    return words;
}

OptionText describe(const CLI::Option& option) {
    OptionText text;
    text.positional = option.get_positional();
    text.required = option.get_required();
    text.description = option.get_description();
    if (option.get_items_expected_max() > 0) {
        text.choices = split_at_bars(option.get_type_name());
        text.value = shown_type(option.get_type_name(), text.is_file);
    }
    text.repeatable = !text.positional && option.get_items_expected_max() > 1;
    for (const std::string& name : option.get_snames()) text.flags.push_back("-" + name);
    for (const std::string& name : option.get_lnames()) text.flags.push_back("--" + name);
    for (const std::string& flag : text.flags) text.names += (text.names.empty() ? "" : ", ") + flag;
    if (text.positional) text.names = text.value;
    return text;
}

} // namespace

CommandText describe(const CLI::App& command) {
    CommandText text;
    text.word = command.get_parent() ? command.get_name() : "";
    text.name = command.get_parent() ? command.get_parent()->get_name() + " " + command.get_name() : command.get_name();
    text.summary = command.get_description();
    text.details = command.get_footer();
    std::vector<OptionText> named;
    for (const CLI::Option* option : command.get_options()) {
        OptionText described = describe(*option);
        (described.positional ? text.options : named).push_back(std::move(described));
    }
    text.usage = text.name + (command.get_parent() ? "" : " COMMAND") + " [OPTIONS]";
    for (const OptionText& option : named) {
        if (option.required) text.usage += " " + option.flags.back() + " " + option.value;
    }
    for (const OptionText& positional : text.options) {
        text.usage += positional.required ? " " + positional.value : " [" + positional.value + "]";
    }
    text.options.insert(text.options.end(), named.begin(), named.end());
    return text;
}

std::vector<CommandText> walk(const CLI::App& program) {
    std::vector<CommandText> commands{describe(program)};
    for (const CLI::App* command : program.get_subcommands([](const CLI::App*) { return true; })) {
        if (!command->get_group().empty()) commands.push_back(describe(*command));
    }
    return commands;
}

std::vector<Paragraph> paragraphs(const std::string& details) {
    std::vector<Paragraph> result;
    bool open = false; // the last paragraph goes on with the next line
    for (std::size_t begin = 0; begin < details.size();) {
        const std::size_t end = std::min(details.find('\n', begin), details.size());
        const std::string line = details.substr(begin, end - begin);
        begin = end + 1;
        if (line.empty()) {
            open = false;
            continue;
        }
        const bool preformatted = line.starts_with("  ");
        if (!open || result.back().preformatted != preformatted) result.push_back({preformatted, {}});
        open = true;
        std::string& text = result.back().text;
        if (preformatted) text += line.substr(2) + "\n";
        else text += (text.empty() ? "" : " ") + line;
    }
    return result;
}

} // namespace isotet::cli
