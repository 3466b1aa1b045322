// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// How options of our kinds are added to a command: numbers in any locale, counts, lists, choices.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

namespace isotet::cli {

/// "--side got 'x', but it takes a whole number". `names` is the option's, the long one last.
CLI::ValidationError wrong_value(const std::string& names, std::string_view given, std::string_view rule);

/// An option with one value, kept as it is.
CLI::Option* add_text(CLI::App& app, const std::string& names, std::string& target, const std::string& type,
                      const std::string& description);

/// The name of a file; an empty one, of a script's empty variable perhaps, is refused.
CLI::Option* add_file(CLI::App& app, const std::string& names, std::string& target, const std::string& type,
                      const std::string& description);

/// A finite number.
CLI::Option* add_number(CLI::App& app, const std::string& names, std::function<void(double)> set,
                        const std::string& type, const std::string& description);

/// A whole number from `lowest` to `highest`.
struct CountLimits {
    std::uint64_t lowest = 0;
    std::uint64_t highest = UINT64_MAX;
};
CLI::Option* add_count(CLI::App& app, const std::string& names, CountLimits limits,
                       std::function<void(std::uint64_t)> set, const std::string& type, const std::string& description);

/// Finite numbers separated by commas; the option may be repeated.
CLI::Option* add_numbers(CLI::App& app, const std::string& names, std::vector<double>& target, const std::string& type,
                         const std::string& description);

/// One of some words.
template <class Value>
CLI::Option* add_choice(CLI::App& app, const std::string& names, Value& target,
                        const std::vector<std::pair<std::string, Value>>& choices, const std::string& description) {
    std::string words;
    for (const auto& [word, value] : choices) words += (words.empty() ? "" : "|") + word;
    CLI::Option* option = app.add_option_function<std::string>(
        names,
        [&target, choices, words, names](const std::string& given) {
            for (const auto& [word, value] : choices) {
                if (word == given) {
                    target = value;
                    return;
                }
            }
            throw wrong_value(names, given, words);
        },
        description);
    return option->type_name(words);
}

} // namespace isotet::cli
