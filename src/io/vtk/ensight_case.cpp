// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/vtk/ensight_case.hpp"

#include <algorithm>
#include <array>
#include <cctype>

#include <fmt/core.h>

#include "io/own/text_scanner.hpp"

namespace isotet::io::vtk {
namespace {

std::vector<std::string_view> words_of(std::string_view line) {
    std::vector<std::string_view> words;
    TextScanner scanner(line);
    for (auto word = scanner.quoted_of_line(); !word.empty(); word = scanner.quoted_of_line()) words.push_back(word);
    return words;
}

std::optional<GoldCase::Variable> variable_of(std::string_view key, const std::vector<std::string_view>& words) {
    struct Kind {
        std::string_view name;
        std::size_t components;
    };
    constexpr std::array kinds{Kind{"scalar", 1}, Kind{"vector", 3}, Kind{"tensor symm", 6}, Kind{"tensor asym", 9}};
    const auto per = key.find(" per ");
    if (per == std::string_view::npos || words.size() < 2) return std::nullopt;
    for (const Kind& kind : kinds)
        if (key.substr(0, per) == kind.name)
            return GoldCase::Variable{std::string(words.back()), kind.components, key.ends_with("node")};
    return std::nullopt;
}

} // namespace

GoldCase parse_case(std::string_view text) {
    GoldCase found;
    TextScanner scanner(text, '#');
    bool lists_numbers = false;
    while (!scanner.at_end()) {
        const std::string_view line = scanner.line();
        const auto colon = line.find(':');
        const auto words = words_of(line.substr(colon == std::string_view::npos ? 0 : colon + 1));
        const auto number = [&] {
            std::uint64_t value = 0;
            if (!words.empty()) TextScanner(words.back()).number(value);
            return value;
        };
        const std::string_view key = line.substr(0, std::min(colon, line.size()));
        if (key == "type") found.is_gold = words.size() == 2 && words[0] == "ensight" && words[1] == "gold";
        else if (key == "time set") ++found.time_sets;
        else if (key == "filename start number") found.first_number = number();
        else if (key == "filename increment") found.increment = number();
        else if (key == "model")
            for (const auto word : words) // after the numbers of sets, before "change_coords_only"
                if (found.model.empty() && std::isdigit(static_cast<unsigned char>(word[0])) == 0) found.model = word;
        if (auto variable = variable_of(key, words)) found.variables.push_back(*std::move(variable));
        if (colon != std::string_view::npos) lists_numbers = key == "filename numbers";
        std::uint64_t value = 0;
        for (const auto word : words)
            if (lists_numbers && TextScanner(word).number(value)) found.numbers.push_back(value);
    }
    return found;
}

std::optional<std::string> name_of_step(const GoldCase& from, std::string name, std::size_t step) {
    const auto first = name.find('*');
    if (first == std::string::npos) return name;
    const auto stars = std::min(name.find_first_not_of('*', first), name.size()) - first;
    if (from.time_sets > 1 || (!from.numbers.empty() && step >= from.numbers.size())) return std::nullopt;
    const std::uint64_t number = from.numbers.empty() ? from.first_number + step * from.increment : from.numbers[step];
    return name.replace(first, stars, fmt::format("{:0{}}", number, stars));
}

} // namespace isotet::io::vtk
