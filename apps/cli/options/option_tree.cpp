// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "options/option_tree.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <optional>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <isotet/fields.hpp>
#include <isotet/grid.hpp>
#include <isotet/jobs/number_text.hpp>

#include "options/command_options.hpp"
#include "exit_code.hpp"
#include "options/options.hpp"

namespace isotet::cli {

namespace {

constexpr int first_error_code = 1000;       ///< above CLI11's own exit codes
constexpr std::string_view rare_mark = "\t"; ///< behind the group of an option that --help-all alone shows

double finite_number(const std::string& names, std::string_view text, std::string_view rule = "a finite number") {
    const std::optional<double> value = parse_number(text);
    if (!value || !std::isfinite(*value)) refuse_value(names, text, rule);
    return *value;
}

void append_numbers_of_file(const std::string& path, std::vector<double>& numbers, const Command::OtherWords& other) {
    std::ifstream file(path);
    if (!file) refuse_file(ErrorCode::file, fmt::format("the file of numbers '{}' cannot be read", path));
    bool any = false;
    std::string line;
    for (std::size_t number = 1; std::getline(file, line); ++number) {
        line.resize(std::min(line.find('#'), line.size()));
        constexpr std::string_view separators = " \t\r\f\v,";
        for (std::size_t begin = 0; (begin = line.find_first_not_of(separators, begin)) != std::string::npos;) {
            const std::size_t end = std::min(line.find_first_of(separators, begin), line.size());
            const std::string word = line.substr(begin, end - begin);
            any = true;
            begin = end;
            if (other.take && other.take(word)) continue;
            const std::optional<double> value = parse_number(word);
            if (!value || !std::isfinite(*value))
                refuse_file(ErrorCode::invalid_data, fmt::format("{}: line {} has '{}', but must have {}", path, number,
                                                                 word, other.take ? other.rule : "finite numbers"));
            numbers.push_back(*value);
        }
    }
    if (!any) refuse_file(ErrorCode::invalid_data, fmt::format("{} has no number, but must have at least one", path));
}

/// An option whose values go to `set`, all at once.
CLI::Option& add_list(CLI::App& app, const std::string& names, const Command::SetTexts& set, const std::string& type,
                      const std::string& description) {
    return *app.add_option_function<std::vector<std::string>>(names, set, description)
                ->type_name(type)
                ->allow_extra_args(!names.starts_with('-')); // "-f a b" leaves b to what follows
}

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

/// Not "N" or "area>A", which stand for words.
bool is_word(const std::string& text) {
    return text.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_-") == std::string::npos;
}

OptionText text_of(const CLI::Option& option) {
    OptionText text;
    text.positional = option.get_positional();
    text.required = option.get_required();
    text.group = option.get_group();
    text.rare = text.group.ends_with(rare_mark);
    if (text.rare) text.group.resize(text.group.size() - rare_mark.size());
    text.description = option.get_description();
    if (option.get_items_expected_max() > 0) {
        text.choices = split_at_bars(option.get_type_name());
        std::erase_if(text.choices, [](const std::string& choice) { return !is_word(choice); });
        text.value = shown_type(option.get_type_name(), text.is_file);
    }
    text.repeatable = !text.positional && option.get_items_expected_max() > 1;
    for (const std::string& name : option.get_snames()) text.flags.push_back("-" + name);
    for (const std::string& name : option.get_lnames()) text.flags.push_back("--" + name);
    for (const std::string& flag : text.flags) text.names += (text.names.empty() ? "" : ", ") + flag;
    if (text.positional) text.names = text.value;
    return text;
}

CommandText text_of(const CLI::App& command) {
    CommandText text;
    text.word = command.get_parent() ? command.get_name() : "";
    text.name = command.get_parent() ? command.get_parent()->get_name() + " " + command.get_name() : command.get_name();
    text.summary = command.get_description();
    text.details = command.get_footer();
    std::vector<OptionText> named;
    for (const CLI::Option* option : command.get_options()) {
        OptionText one = text_of(*option);
        (one.positional ? text.options : named).push_back(std::move(one));
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

/// nullptr when there is no such command.
const CLI::App* find(const CLI::App& program, const std::string& word) {
    const auto found = program.get_subcommands([&](const CLI::App* command) { return command->get_name() == word; });
    return found.empty() ? nullptr : found.front();
}

/// The word of the command that was parsed; empty for none.
std::string parsed_command(const CLI::App& program) {
    const std::vector<CLI::App*> parsed = program.get_subcommands();
    return parsed.empty() ? "" : parsed.back()->get_name();
}

/// "there is no option '--isovalues'; the nearest is --isovalue", where one is near; empty when all options are known. A word
/// that is missing elsewhere, such as FILE, matters less.
std::string unknown_option(const CLI::App& program, const CommandText& command) {
    std::vector<std::string> flags;
    for (const OptionText& option : command.options)
        if (!option.flags.empty()) flags.push_back(option.flags.back());
    for (const std::string& word : program.remaining(true)) {
        if (word.size() < 2 || word.front() != '-' || word == "--") continue;
        const std::string name = word.substr(0, word.find('='));
        const std::string nearest = nearest_first(name, flags).front();
        const bool is_near = name.size() > 3 && nearest.substr(0, 4) == name.substr(0, 4); // "--is"
        return fmt::format("there is no option '{}'{}", name, is_near ? "; the nearest is " + nearest : "");
    }
    return {};
}

std::string one_word_too_many(std::string_view number) {
    return fmt::format("'{}' is one word too many; several numbers stand in a list, such as -i 0.1,0.2", number);
}

/// For numbers that follow a list after a space: "0.2 is one word too many; ...". Empty where it is something else.
std::string number_too_many(const CLI::App& program) {
    for (const std::string& word : program.remaining(true))
        if (parse_number(word)) return one_word_too_many(word);
    return {};
}

/// Whether some command has the option -c.
bool has_short_option(const CLI::App& app, char c) {
    const auto has_it = [&](const CLI::Option* option) { return option->check_sname(std::string(1, c)); };
    const std::vector<const CLI::Option*> own = app.get_options();
    if (std::any_of(own.begin(), own.end(), has_it)) return true;
    const std::vector<const CLI::App*> commands = app.get_subcommands([](const CLI::App*) { return true; });
    return std::any_of(commands.begin(), commands.end(),
                       [&](const CLI::App* command) { return has_short_option(*command, c); });
}

} // namespace

void refuse_file(ErrorCode code, std::string sentence) {
    throw CLI::ValidationError(std::move(sentence), first_error_code + static_cast<int>(code));
}

void refuse_loose_number(std::string_view word) {
    if (parse_number(word)) throw CLI::ValidationError(one_word_too_many(word));
}

void refuse_value(const std::string& names, std::string_view given, std::string_view rule) {
    const std::string name = names.substr(names.rfind(',') + 1); // npos + 1 is 0
    throw CLI::ValidationError(fmt::format("{} got '{}', but it takes {}", name, given, rule));
}

const Option& Option::required() const {
    option_->required();
    return *this;
}

const Option& Option::excludes(const Option& other) const {
    option_->excludes(other.option_);
    return *this;
}

const Option& Option::needs(const Option& other) const {
    option_->needs(other.option_);
    return *this;
}

Command Command::add_command(const std::string& word, const std::string& summary) const {
    return Command(*app_->add_subcommand(word, summary), *number_files_);
}

void Command::set_details(const std::string& details) const { app_->footer(details); }

void Command::set_common(const std::vector<std::string>& names) const {
    std::vector<const CLI::Option*> common{app_->get_help_ptr(), app_->get_help_all_ptr()};
    for (const std::string& name : names) common.push_back(app_->get_option(name));
    for (CLI::Option* option : app_->get_options())
        if (!option->get_positional() && std::ranges::find(common, option) == common.end())
            option->group(option->get_group() + std::string(rare_mark));
}

OptionGroup::OptionGroup(const Command& command, const std::string& heading)
    : app_(command.app_), outer_(app_->option_defaults()->get_group()) {
    app_->option_defaults()->group(heading);
}

OptionGroup::~OptionGroup() { app_->option_defaults()->group(outer_); }

void Command::hide() const { app_->group(""); }

Option Command::option(const std::string& name) const { return Option(*app_->get_option(name)); }

Option Command::add_flag(const std::string& names, bool& target, const std::string& description) const {
    return Option(*app_->add_flag(names, target, description));
}

Option Command::add_text(const std::string& names, std::string& target, const std::string& type,
                         const std::string& description) const {
    return add_value(names, [&target](const std::string& text) { target = text; }, type, description);
}

Option Command::add_file(const std::string& names, std::string& target, const std::string& type,
                         const std::string& description) const {
    return add_value(
        names,
        [&target, names](const std::string& name) {
            if (name.empty()) refuse_value(names, name, "the name of a file");
            target = name;
        },
        type, description);
}

Option Command::add_value(const std::string& names, std::function<void(const std::string&)> set,
                          const std::string& type, const std::string& description) const {
    return Option(*app_->add_option_function<std::string>(names, set, description)->type_name(type));
}

Option Command::add_number(const std::string& names, std::function<void(double)> set, const std::string& type,
                           const std::string& description) const {
    return add_value(
        names, [set = std::move(set), names](const std::string& text) { set(finite_number(names, text)); }, type,
        description);
}

Option Command::add_count(const std::string& names, CountLimits limits, std::function<void(std::uint64_t)> set,
                          const std::string& type, const std::string& description) const {
    return add_value(
        names,
        [set = std::move(set), names, limits](const std::string& text) {
            const std::optional<std::uint64_t> value = parse_count(text);
            if (!value || *value < limits.lowest || *value > limits.highest) {
                const std::string upwards = limits.highest == UINT64_MAX ? "on" : fmt::format("to {}", limits.highest);
                refuse_value(names, text, fmt::format("a whole number from {} {}", limits.lowest, upwards));
            }
            set(*value);
        },
        type, description);
}

Option Command::add_numbers(const std::string& names, std::vector<double>& target, const std::string& type,
                            const std::string& description, OtherWords other) const {
    return add_texts(
        names,
        [&target, &files = *number_files_, names, other](const std::vector<std::string>& lists) {
            if (other.see) other.see(lists);
            for (const std::string& list : lists) {
                if (list.starts_with('@')) {
                    append_numbers_of_file(list.substr(1), target, other);
                    files.push_back(list.substr(1));
                    continue;
                }
                for (std::size_t begin = 0; begin <= list.size();) {
                    const std::size_t end = std::min(list.find(',', begin), list.size());
                    const std::string_view word = std::string_view(list).substr(begin, end - begin);
                    if (!other.take || !other.take(word)) target.push_back(finite_number(names, word, other.rule));
                    begin = end + 1;
                }
            }
        },
        type, description);
}

Option Command::add_texts(const std::string& names, SetTexts set, const std::string& type,
                          const std::string& description) const {
    return Option(add_list(*app_, names, set, type, description));
}

Option Command::add_words(const std::string& names, SetTexts set, const std::string& type,
                          const std::string& description) const {
    return Option(*add_list(*app_, names, set, type, description).delimiter(','));
}

Command::NamedText Command::text_of_file(const std::string& given) const {
    NamedText out{given.substr(1), {}, {}};
    std::ifstream file(out.file);
    const std::size_t colon = out.file.rfind(':');
    if (!file && colon != std::string::npos) {
        out.name = out.file.substr(colon + 1);
        out.file.resize(colon);
        file.open(out.file);
    }
    std::array<char, 4096> bytes; // read() throws at no folder
    while (file.read(bytes.data(), bytes.size()) || file.gcount() > 0)
        out.text.append(bytes.data(), static_cast<std::size_t>(file.gcount()));
    if (!file.eof()) refuse_file(ErrorCode::file, fmt::format("the file '{}' cannot be read", out.file));
    number_files_->push_back(out.file);
    return out;
}

Option Command::add_one_of(const std::string& names, std::vector<std::string> words,
                           std::function<void(std::size_t)> set, const std::function<void(const NamedText&)>& set_file,
                           const std::string& description) const {
    const std::string type = fmt::format("{}{}", fmt::join(words, "|"), set_file ? "|@JSON[:NAME]" : "");
    return add_value(
        names,
        [words = std::move(words), set = std::move(set), set_file, type, names,
         command = *this](const std::string& given) {
            if (set_file && given.starts_with('@')) return set_file(command.text_of_file(given));
            const auto found = std::find(words.begin(), words.end(), given);
            if (found == words.end()) refuse_value(names, given, type);
            set(static_cast<std::size_t>(found - words.begin()));
        },
        type, description);
}

OptionTree::OptionTree(CommandLine& line)
    : line_(&line), program_(std::make_unique<CLI::App>("Isosurfaces of large unstructured grids", "isotet")) {
    program_->require_subcommand(0, 1);
    program_->set_help_all_flag("--help-all", "Show all options, and details"); // its commands have it, too
    add_commands(Command(*program_, line.number_files), line);
}

OptionTree::~OptionTree() = default;

std::vector<std::string> OptionTree::words() const {
    std::vector<std::string> words;
    for (const CommandText& command : describe_all())
        if (!command.word.empty()) words.push_back(command.word);
    return words;
}

bool OptionTree::has_command(const std::string& word) const { return find(*program_, word) != nullptr; }

Result<void> OptionTree::parse(const std::vector<std::string>& words) {
    std::vector<std::string> backwards(words.rbegin(), words.rend() - (words.empty() ? 0 : 1));
    for (std::string& word : backwards) // CLI11 takes -i=3 as the value "=3"
        if (word.size() > 3 && word[0] == '-' && word[2] == '=' && has_short_option(*program_, word[1]))
            word.erase(2, 1);
    for (std::size_t i = backwards.size(); i-- > 0;) // it takes --with= as --with without a value
        if (backwards[i].starts_with("--") && backwards[i].size() > 3 &&
            backwards[i].find('=') == backwards[i].size() - 1) {
            backwards[i].pop_back();
            backwards.insert(backwards.begin() + static_cast<std::ptrdiff_t>(i), std::string());
        }
    try {
        program_->parse(backwards); // CLI11 takes the words from the back
    } catch (const CLI::CallForHelp&) {
        line_->help = Help::common;
    } catch (const CLI::CallForAllHelp&) {
        line_->help = Help::all;
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() >= first_error_code)
            return Error{static_cast<ErrorCode>(error.get_exit_code() - first_error_code), error.what()};
        const std::string command = parsed_command(*program_);
        std::string unknown = unknown_option(*program_, describe(command));
        if (unknown.empty()) unknown = number_too_many(*program_);
        return usage_error("{} (isotet{}{} --help-all lists the options)", unknown.empty() ? error.what() : unknown,
                           command.empty() ? "" : " ", command);
    }
    line_->command = parsed_command(*program_);
    return {};
}

std::vector<CommandText> OptionTree::describe_all() const {
    std::vector<CommandText> commands{text_of(*program_)};
    for (const CLI::App* command : program_->get_subcommands([](const CLI::App*) { return true; })) {
        if (!command->get_group().empty()) commands.push_back(text_of(*command));
    }
    return commands;
}

CommandText OptionTree::describe(const std::string& word) const {
    const CLI::App* command = find(*program_, word);
    return text_of(command ? *command : *program_);
}

} // namespace isotet::cli
