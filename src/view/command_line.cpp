// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "view/command_line.hpp"

#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace isotet::view {

namespace {

/// "--name", "value"; one word where the value looks like an option itself.
void add_option(std::vector<std::string>& words, const std::string& name, const std::string& value) {
    if (value.starts_with('-')) words.push_back(name + "=" + value);
    else words.insert(words.end(), {name, value});
}

void add_field(std::vector<std::string>& words, const ViewState& state) {
    if (!state.field.empty()) add_option(words, "--field", state.field);
}

void add_volume(std::vector<std::string>& words, const VolumeState& volume) {
    words.emplace_back("--volume");
    add_option(words, "--opacity", volume.opacity);
    if (volume.length) add_option(words, "--opacity-length", fmt::format("{}", *volume.length));
    if (volume.shaded) words.emplace_back("--volume-shading");
}

/// Opacity of the boundary where isotet render is told nothing of it.
double boundary_by_itself(const ViewState& state) { return state.volume ? 0 : default_boundary_opacity; }

void add_isovalues(std::vector<std::string>& words, const ViewState& state) {
    if (!state.isovalues.empty()) add_option(words, "--isovalue", fmt::format("{}", fmt::join(state.isovalues, ",")));
    if (state.solid && !state.volume) add_option(words, "--solid", std::string(name_of(*state.solid)));
    if (state.keep) add_option(words, "--keep", to_text(*state.keep));
}

std::vector<std::string> first_words(const char* command, const std::string& file,
                                     const std::vector<std::string>& reading, const ViewState& state) {
    std::vector<std::string> words{"isotet", command, file.starts_with('-') ? "./" + file : file};
    words.insert(words.end(), reading.begin(), reading.end());
    for (const std::string& cells : state.cells) add_option(words, "--cells", cells);
    if (state.step) words.insert(words.end(), {"--step", std::to_string(*state.step)});
    return words;
}

std::string plane_text(const Plane& plane) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        std::array<double, 3> unit{};
        for (const double sign : {1.0, -1.0}) {
            unit[axis] = sign;
            if (plane.normal == unit)
                return fmt::format("{}{}={}", sign < 0 ? "-" : "", "xyz"[axis],
                                   plane.offset == 0 ? 0 : sign * plane.offset);
        }
    }
    return fmt::format("{},{}", fmt::join(plane.normal, ","), plane.offset);
}

bool is_plain(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
           std::string_view("_-+.,:/=@%").find(c) != std::string_view::npos;
}

} // namespace

std::vector<std::string> extract_words(const ViewState& state, const std::string& file,
                                       const std::vector<std::string>& reading) {
    std::vector<std::string> words = first_words("extract", file, reading, state);
    add_field(words, state);
    add_isovalues(words, state);
    words.insert(words.end(), {"-o", "surface.vtp"});
    return words;
}

std::vector<std::string> extract_all_words(ViewState state, const std::string& file,
                                           const std::vector<std::string>& reading) {
    state.step.reset();
    std::vector<std::string> words = extract_words(state, file, reading);
    words.back() = "surface-{step}.vtp";
    words.insert(words.end() - 2, "--all-steps");
    return words;
}

std::vector<std::string> render_words(const ViewState& state, const std::string& file,
                                      const std::vector<std::string>& reading) {
    std::vector<std::string> words = first_words("render", file, reading, state);
    if (state.volume) add_volume(words, *state.volume);
    const bool colors_boundary = !state.volume && state.colored_boundary && !state.color_by.empty();
    if (state.isosurfaces || state.volume || (!colors_boundary && !state.slices.empty())) add_field(words, state);
    if (state.volume ? state.volume->surfaces : state.isosurfaces) add_isovalues(words, state);
    if (colors_boundary) add_option(words, "--boundary-color-by", state.color_by);
    if (!state.color_by.empty() && (!colors_boundary || state.isosurfaces || !state.slices.empty()))
        add_option(words, "--color-by", state.color_by);
    if (state.map != ColorMap::viridis) add_option(words, "--colormap", std::string(name_of(state.map)));
    if (state.range) add_option(words, "--range", fmt::format("{},{}", state.range->lower, state.range->upper));
    if (state.logarithmic) words.emplace_back("--log");
    if (state.opacity) add_option(words, "--opacity", fmt::format("{}", *state.opacity));
    if (state.outline) words.emplace_back("--outline");
    if (state.edges) words.emplace_back("--edges");
    if (state.boundary != (colors_boundary ? 1 : boundary_by_itself(state)))
        add_option(words, "--boundary", fmt::format("{}", state.boundary));
    for (const Plane& plane : state.clips) add_option(words, "--clip", plane_text(plane));
    for (const Plane& plane : state.slices) add_option(words, "--slice", plane_text(plane));
    if (state.stretch) add_option(words, "--scale", fmt::format("{}", fmt::join(*state.stretch, ",")));
    if (state.camera) add_option(words, "--camera", to_text(*state.camera));
    words.insert(words.end(), {"-o", "picture.png"});
    return words;
}

std::string shell_text(const std::vector<std::string>& words) {
    std::string text;
    for (const std::string& word : words) {
        if (!text.empty()) text += ' ';
        if (!word.empty() && std::ranges::all_of(word, is_plain)) {
            text += word;
            continue;
        }
        text += '\'';
        for (const char c : word) {
            if (c == '\'') text += "'\\''";
            else text += c;
        }
        text += '\'';
    }
    return text;
}

Result<std::vector<std::string>> shell_words(std::string_view text) {
    std::vector<std::string> words;
    std::string word;
    bool in_word = false;
    char quote = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (quote == 0 && (c == ' ' || c == '\t' || c == '\n' || c == '\r')) {
            if (in_word) words.push_back(std::move(word));
            word.clear();
            in_word = false;
            continue;
        }
        if (c == '\\' && quote != '\'' && i + 1 < text.size() && text[i + 1] == '\n') { // the line goes on
            ++i;
            continue;
        }
        in_word = true;
        if (quote == 0 && (c == '\'' || c == '"')) quote = c;
        else if (c == quote && quote != 0) quote = 0;
        else if (c == '\\' && quote != '\'') {
            if (++i == text.size())
                return Error{ErrorCode::invalid_argument, "the command line ends in \\, which takes another character"};
            if (quote == '"' && std::string_view("$`\"\\").find(text[i]) == std::string_view::npos) word += '\\';
            word += text[i];
        } else word += c;
    }
    if (quote != 0)
        return Error{ErrorCode::invalid_argument, fmt::format("the command line has a {} without its end", quote)};
    if (in_word) words.push_back(std::move(word));
    return words;
}

} // namespace isotet::view
