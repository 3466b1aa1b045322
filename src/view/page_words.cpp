// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "view/page_words.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>
#include <utility>

namespace isotet::view {

namespace {

using std::string_view_literals::operator""sv;

constexpr std::array controls = std::to_array<std::pair<std::string_view, std::string_view>>({{"field", "Field"},
                                                                                              {"isovalue", "Isovalue"},
                                                                                              {"step", "Time step"},
                                                                                              {"time", "Time"},
                                                                                              {"color_by", "Colour by"},
                                                                                              {"range", "Range"},
                                                                                              {"boundary", "Boundary"},
                                                                                              {"scale", "Heights"},
                                                                                              {"solid", "Solid"},
                                                                                              {"keep", "Keep"},
                                                                                              {"opacity", "Opacity"}});

/// Options of isotet view that the page has no control for.
constexpr std::array view_options{
    "allow_host"sv,     "allow_outside"sv, "beside"sv,      "block"sv,     "cell_field"sv,
    "cells"sv,          "displace"sv,      "distance"sv,    "format"sv,    "geometry_tolerance"sv,
    "hanging_points"sv, "json"sv,          "keep_pieces"sv, "listen"sv,    "memory"sv,
    "merge_points"sv,   "merge_values"sv,  "no_browser"sv,  "out"sv,       "pages"sv,
    "port"sv,           "quiet"sv,         "threads"sv,     "tolerance"sv, "verbose"sv};

/// `marked`   the option with its backquotes
std::string control_of(std::string_view option, std::string_view marked) {
    for (const auto& [name, control] : controls)
        if (name == option) return std::string(control);
    if (std::ranges::find(view_options, option) == view_options.end()) return std::string(marked);
    std::string words(option);
    std::ranges::replace(words, '_', '-');
    return "isotet view --" + words;
}

/// The length of what stands between two equal marks at the beginning, with them; 0: there is no second one.
std::size_t marked_length(std::string_view text) {
    const std::size_t end = text.find(text.front(), 1);
    return end == std::string_view::npos ? 0 : end + 1;
}

} // namespace

std::string page_words(std::string_view sentence) {
    std::string words;
    while (!sentence.empty()) {
        const char first = sentence.front();
        const std::size_t length = first == '\'' || first == '`' ? marked_length(sentence) : 0;
        const std::string_view inside = length > 2 ? sentence.substr(1, length - 2) : std::string_view();
        const bool is_option = first == '`' && !inside.empty() &&
                               std::ranges::all_of(inside, [](char c) { return (c >= 'a' && c <= 'z') || c == '_'; });
        const std::size_t taken = std::max<std::size_t>(1, length);
        if (is_option) words += control_of(inside, sentence.substr(0, taken));
        else words += sentence.substr(0, taken);
        sentence.remove_prefix(taken);
    }
    return words;
}

} // namespace isotet::view
