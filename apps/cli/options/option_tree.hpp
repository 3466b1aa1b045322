// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The commands and options of the program, once: parsing, --help, man page, completion and docs/command-line.md all
// come from this tree. CLI11, which parses, is included only by option_tree.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <isotet/result.hpp>

#include "options/command_text.hpp"

namespace CLI {
class App;
class Option;
} // namespace CLI

namespace isotet::cli {

struct CommandLine;

/// Refuses a number where the name of a file is expected: it belongs to a list before it.
void refuse_loose_number(std::string_view word);

/// Refuses a value during parsing: "--side got 'x', but it takes a whole number". `names` is the option's, the long one
/// last.
[[noreturn]] void refuse_value(const std::string& names, std::string_view given, std::string_view rule);

/// Refuses a file that is read during parsing, whose OptionTree::parse() then makes an error of this code.
[[noreturn]] void refuse_file(ErrorCode code, std::string sentence);

/// One option of a command.
class Option {
public:
    explicit Option(CLI::Option& option) : option_(&option) {}

    const Option& required() const;
    /// The two cannot be given together.
    const Option& excludes(const Option& other) const;
    const Option& needs(const Option& other) const;

private:
    CLI::Option* option_;
};

/// A whole number from `lowest` to `highest`.
struct CountLimits {
    std::uint64_t lowest = 0;
    std::uint64_t highest = UINT64_MAX;
};

/// One command, or the program itself. The tree keeps it; a Command is only a handle.
///
/// `names`   "-f,--field", or "FILE" for a positional
/// `type`    how the value is called; one with bars ("none|gradient|face") is a list of choices, one that ends in FILE
///           is a file's name
/// `target`  is set when the command line is parsed; must live until then. So must what a `set` refers to.
class Command {
public:
    /// `number_files`   gets the names of files that are read while the command line is parsed
    Command(CLI::App& app, std::vector<std::string>& number_files) : app_(&app), number_files_(&number_files) {}

    Command add_command(const std::string& word, const std::string& summary) const;

    /// What --help says below the options (CommandText::details).
    void set_details(const std::string& details) const;

    /// Call it when the command has all of its options. --help shows these, by their long names, and --help-all all.
    void set_common(const std::vector<std::string>& names) const;

    /// Leaves the command out of --help, man page, completions and markdown.
    void hide() const;

    /// The option that has this name.
    Option option(const std::string& name) const;

    Option add_flag(const std::string& names, bool& target, const std::string& description) const;

    /// Text, kept as it is.
    Option add_text(const std::string& names, std::string& target, const std::string& type,
                    const std::string& description) const;

    /// The name of a file; an empty one, of a script's empty variable perhaps, is refused.
    Option add_file(const std::string& names, std::string& target, const std::string& type,
                    const std::string& description) const;

    /// Text that `set` understands, or refuses by refuse_value().
    Option add_value(const std::string& names, std::function<void(const std::string&)> set, const std::string& type,
                     const std::string& description) const;

    /// A finite number, which `set` may refuse.
    Option add_number(const std::string& names, std::function<void(double)> set, const std::string& type,
                      const std::string& description) const;

    Option add_count(const std::string& names, CountLimits limits, std::function<void(std::uint64_t)> set,
                     const std::string& type, const std::string& description) const;

    /// Finite numbers separated by commas, or "@FILE": a file of numbers separated by blanks, commas or line ends; #
    /// begins a comment. The option may be repeated.
    /// Words that may stand beside numbers.
    struct OtherWords {
        std::function<bool(std::string_view word)> take = {};                ///< false: the word is none
        const char* rule = "a finite number";                                ///< what an item of the list may be
        std::function<void(const std::vector<std::string>& lists)> see = {}; ///< sees them before they are taken apart
    };
    Option add_numbers(const std::string& names, std::vector<double>& target, const std::string& type,
                       const std::string& description, OtherWords other) const;
    Option add_numbers(const std::string& names, std::vector<double>& target, const std::string& type,
                       const std::string& description) const {
        return add_numbers(names, target, type, description, OtherWords());
    }

    using SetTexts = std::function<void(const std::vector<std::string>&)>;

    /// One text each time; the option may be repeated.
    Option add_texts(const std::string& names, SetTexts set, const std::string& type,
                     const std::string& description) const;

    /// Words separated by commas; the option may be repeated.
    Option add_words(const std::string& names, SetTexts set, const std::string& type,
                     const std::string& description) const;

    /// One of some words.
    template <class Value>
    Option add_choice(const std::string& names, Value& target,
                      const std::vector<std::pair<std::string, Value>>& choices, const std::string& description) const {
        return add_choice_or_file(names, target, choices, {}, description);
    }

    /// The text of a file, and the name that an option has behind it.
    struct NamedText {
        std::string file, text, name;
    };
    /// The same, or "@FILE" or "@FILE:NAME", which `set` takes.
    template <class Value>
    Option add_choice_or_file(const std::string& names, Value& target,
                              const std::vector<std::pair<std::string, Value>>& choices,
                              const std::function<void(const NamedText&)>& set, const std::string& description) const {
        std::vector<std::string> words;
        for (const auto& [word, value] : choices) words.push_back(word);
        return add_one_of(
            names, std::move(words), [&target, choices](std::size_t chosen) { target = choices[chosen].second; }, set,
            description);
    }

    /// The file of "@FILE" or "@FILE:NAME". Refuses one that cannot be read.
    NamedText text_of_file(const std::string& given) const;

private:
    friend class OptionGroup;

    /// `set` is called with the number of the chosen word, `set_file` where there is one with a file instead.
    Option add_one_of(const std::string& names, std::vector<std::string> words, std::function<void(std::size_t)> set,
                      const std::function<void(const NamedText&)>& set_file, const std::string& description) const;

    CLI::App* app_;
    std::vector<std::string>* number_files_;
};

/// Options that are added while it lives stand under this heading in --help-all.
class OptionGroup {
public:
    OptionGroup(const Command& command, const std::string& heading);
    ~OptionGroup();
    OptionGroup(const OptionGroup&) = delete;
    OptionGroup& operator=(const OptionGroup&) = delete;

private:
    CLI::App* app_;
    std::string outer_;
};

class OptionTree {
public:
    /// `line`  is filled by parse(); must outlive the tree
    explicit OptionTree(CommandLine& line);
    ~OptionTree();

    std::vector<std::string> words() const; ///< of the commands that are not hidden

    /// True for the word of a command, hidden or not.
    bool has_command(const std::string& word) const;

    /// Parses a command line, argv[0] first. With --help only `command` and `help` of the CommandLine are set.
    ///
    /// Errors   invalid_argument; file and invalid_data for a file that is read meanwhile
    Result<void> parse(const std::vector<std::string>& words);

    /// The program, then its commands in order; hidden ones are left out.
    std::vector<CommandText> describe_all() const;

    /// One command, hidden or not; the program itself for the empty word.
    CommandText describe(const std::string& word) const;

private:
    CommandLine* line_;
    std::unique_ptr<CLI::App> program_;
};

} // namespace isotet::cli
