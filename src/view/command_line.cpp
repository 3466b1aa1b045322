// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "view/command_line.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <isotet/opacity.hpp>

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
}

/// Opacity of the boundary where isotet render is told nothing of it.
double boundary_by_itself(const ViewState& state) { return state.volume ? 0 : default_boundary_opacity; }

void add_isovalues(std::vector<std::string>& words, const ViewState& state) {
    if (!state.isovalues.empty()) add_option(words, "--isovalue", fmt::format("{}", fmt::join(state.isovalues, ",")));
    if (state.solid && !state.volume) add_option(words, "--solid", std::string(name_of(*state.solid)));
    if (state.keep) add_option(words, "--keep", to_text(*state.keep));
}

std::vector<std::string> first_words(const char* command, const std::string& file,
                                     const std::vector<std::string>& reading,
                                     const std::optional<std::uint64_t>& step) {
    std::vector<std::string> words{"isotet", command, file.starts_with('-') ? "./" + file : file};
    words.insert(words.end(), reading.begin(), reading.end());
    if (step) words.insert(words.end(), {"--step", std::to_string(*step)});
    return words;
}

std::optional<double> number_of(std::string_view text) {
    double value = 0;
    if (text.starts_with('+')) text.remove_prefix(1);
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
    return value == 0 ? 0 : value;
}

std::optional<std::vector<double>> numbers_of(std::string_view text) {
    std::vector<double> numbers;
    while (true) {
        const std::size_t comma = text.find(',');
        const auto number = number_of(text.substr(0, comma));
        if (!number) return std::nullopt;
        numbers.push_back(*number);
        if (comma == std::string_view::npos) return numbers;
        text.remove_prefix(comma + 1);
    }
}

/// What a value of an option does to a state; false: it is not one that the option takes.
using SetOption = bool (*)(ViewState& state, const std::string& value);

struct PageOption {
    std::string_view name, short_name;
    std::string_view rule;
    SetOption set;
};

bool set_isovalues(ViewState& state, const std::string& value) {
    const auto numbers = numbers_of(value);
    if (!numbers || state.isovalues.size() + numbers->size() > max_isovalues) return false;
    state.isovalues.insert(state.isovalues.end(), numbers->begin(), numbers->end());
    return true;
}

bool set_range(ViewState& state, const std::string& value) {
    const auto ends = numbers_of(value);
    if (!ends || ends->size() != 2 || !((*ends)[0] < (*ends)[1])) return false;
    state.range = ValueRange{(*ends)[0], (*ends)[1]};
    return true;
}

VolumeState& volume_in(ViewState& state) {
    if (!state.volume) state.volume.emplace();
    return *state.volume;
}

/// A number is the opacity of surfaces, all else that of a volume.
bool set_opacity(ViewState& state, const std::string& value) {
    if (const auto number = number_of(value)) {
        state.opacity = number;
        return *number >= 0 && *number <= 1;
    }
    if (value.size() > max_name_bytes || !parse_opacity(value)) return false;
    volume_in(state).opacity = value;
    return true;
}

bool set_name(std::string& target, const std::string& value) {
    if (value.size() > max_name_bytes) return false;
    target = value;
    return true;
}

constexpr PageOption page_options[] = {
    {"--field", "-f", "a name of at most 4096 bytes",
     [](ViewState& state, const std::string& value) { return set_name(state.field, value); }},
    {"--isovalue", "-i", "numbers separated by commas, at most 32 of them", set_isovalues},
    {"--color-by", "", "a name of at most 4096 bytes",
     [](ViewState& state, const std::string& value) { return set_name(state.color_by, value); }},
    {"--colormap", "", "a colour map",
     [](ViewState& state, const std::string& value) {
         const auto map = parse_color_map(value);
         if (map) state.map = *map;
         return map.has_value();
     }},
    {"--range", "", "two numbers, the smaller one first", set_range},
    {"--opacity", "", "a number from 0 to 1; of a volume VALUE:OPACITY,VALUE:OPACITY,..., ramp, peaks or shell",
     set_opacity},
    {"--opacity-length", "", "a number above 0",
     [](ViewState& state, const std::string& value) {
         VolumeState& volume = volume_in(state);
         volume.length = number_of(value);
         return volume.length && *volume.length > 0;
     }},
    {"--camera", "", "a camera as isotet render tells it",
     [](ViewState& state, const std::string& value) {
         if (value.size() <= max_name_bytes) state.camera = parse_camera(value);
         return state.camera.has_value();
     }},
};

/// "x=0.5", "-x=0.5" and "NX,NY,NZ,OFFSET", as isotet render takes it.
std::optional<Plane> plane_of(std::string_view text) {
    const std::size_t equals = text.find('=');
    if (equals == std::string_view::npos) {
        const auto numbers = numbers_of(text);
        if (!numbers || numbers->size() != 4) return {};
        const Plane plane{{(*numbers)[0], (*numbers)[1], (*numbers)[2]}, (*numbers)[3]};
        return plane.normal == std::array<double, 3>{} ? std::nullopt : std::optional(plane);
    }
    std::string_view axis = text.substr(0, equals);
    const bool minus = axis.starts_with('-');
    if (minus || axis.starts_with('+')) axis.remove_prefix(1);
    const auto offset = number_of(text.substr(equals + 1));
    if (axis.size() != 1 || axis[0] < 'x' || axis[0] > 'z' || !offset) return {};
    Plane plane{{0, 0, 0}, minus && *offset != 0 ? -*offset : *offset};
    plane.normal[static_cast<std::size_t>(axis[0] - 'x')] = minus ? -1 : 1;
    return plane;
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

bool add_plane(std::vector<Plane>& planes, const std::string& value) {
    const auto plane = plane_of(value);
    if (!plane || planes.size() >= max_planes) return false;
    planes.push_back(*plane);
    return true;
}

constexpr std::string_view plane_rule = "x=0.5, -x=0.5 (y and z alike), or NX,NY,NZ,OFFSET, at most 6 times";

constexpr PageOption more_page_options[] = {
    {"--boundary", "", "a number from 0 to 1",
     [](ViewState& state, const std::string& value) {
         const auto opacity = number_of(value);
         if (opacity) state.boundary = *opacity;
         return opacity && *opacity >= 0 && *opacity <= 1;
     }},
    {"--boundary-color-by", "", "a name of at most 4096 bytes",
     [](ViewState& state, const std::string& value) {
         state.colored_boundary = true;
         return set_name(state.color_by, value);
     }},
    {"--clip", "", plane_rule,
     [](ViewState& state, const std::string& value) { return add_plane(state.clips, value); }},
    {"--slice", "", plane_rule,
     [](ViewState& state, const std::string& value) { return add_plane(state.slices, value); }},
    {"--solid", "", "above or below",
     [](ViewState& state, const std::string& value) {
         state.solid = parse_solid_side(value);
         return state.solid.has_value();
     }},
    {"--keep", "", shown_parts_rule,
     [](ViewState& state, const std::string& value) {
         state.keep = parse_shown_parts(value);
         return state.keep.has_value();
     }},
    {"--step", "", "a whole number",
     [](ViewState& state, const std::string& value) {
         std::uint64_t step = 0;
         const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), step);
         if (error != std::errc() || end != value.data() + value.size()) return false;
         state.step = step;
         return true;
     }},
};

const PageOption* find_option(std::string_view name) {
    const auto is_named = [&](const PageOption& option) {
        return name == option.name || (!option.short_name.empty() && name == option.short_name);
    };
    if (const auto* found = std::ranges::find_if(page_options, is_named); found != std::end(page_options)) return found;
    const auto* found = std::ranges::find_if(more_page_options, is_named);
    return found == std::end(more_page_options) ? nullptr : found;
}

/// A word with its value: "--range=0,1", "-i0.5", or "--range" with the next word.
struct GivenOption {
    const PageOption* option = nullptr;
    std::optional<std::string> value;
};

GivenOption option_of(const std::string& word) {
    if (const PageOption* option = find_option(word)) return {option, std::nullopt};
    const std::size_t equals = word.find('=');
    if (word.starts_with("--") && equals != std::string::npos)
        return {find_option(word.substr(0, equals)), word.substr(equals + 1)};
    if (word.size() > 2 && word[0] == '-' && word[1] != '-') return {find_option(word.substr(0, 2)), word.substr(2)};
    return {};
}

bool set_flag(ViewState& state, std::string_view word) {
    if (word == "--log") return state.logarithmic = true;
    if (word == "--outline") return state.outline = true;
    if (word == "--edges") return state.edges = true;
    if (word == "--volume") {
        volume_in(state);
        return true;
    }
    return false;
}

/// Where the words behind "isotet render" begin; 0 where the first one is an option.
Result<std::size_t> begin_of_options(const std::vector<std::string>& words) {
    constexpr std::array<std::string_view, 3> commands{"render", "extract", "view"};
    const auto is_command = [&](std::size_t i) {
        return i < words.size() && std::ranges::find(commands, words[i]) != commands.end();
    };
    if (words.empty() || words[0].starts_with('-')) return std::size_t{0};
    const std::string_view program = std::string_view(words[0]).substr(words[0].rfind('/') + 1);
    if (program == "isotet" && is_command(1)) return std::size_t{2};
    if (is_command(0)) return std::size_t{1};
    return Error{ErrorCode::invalid_argument,
                 fmt::format("'{}' begins no command line of isotet render, isotet extract or isotet view", words[0])};
}

/// Options that say nothing about what is seen.
bool is_of_the_machine(std::string_view word) {
    constexpr std::array<std::string_view, 12> with_value{"-o",        "--output", "--size",   "--json",
                                                          "--threads", "--device", "--port",   "--listen",
                                                          "--engine",  "--out",    "--method", "--snap"};
    return std::ranges::find(with_value, word.substr(0, word.find('='))) != with_value.end();
}

bool is_flag_of_the_machine(std::string_view word) {
    constexpr std::array<std::string_view, 7> flags{"-q",      "--quiet",      "-v",           "--verbose",
                                                    "--plain", "--no-browser", "--allow-empty"};
    return std::ranges::find(flags, word) != flags.end();
}

/// A word that is no option of the page: the file, what does not matter here, or what is left out. Returns how many
/// words behind it go with it.
std::size_t pass_over(const std::vector<std::string>& words, std::size_t i, const std::vector<std::string>& reading,
                      PastedCommand& pasted) {
    const std::string& word = words[i];
    if (is_flag_of_the_machine(word)) return 0;
    if (!word.starts_with('-') || word == "-") {
        if (pasted.file.empty()) pasted.file = word;
        return 0; // or the name of what is written
    }
    const bool has_value =
        word.find('=') == std::string::npos && i + 1 < words.size() && !words[i + 1].starts_with('-');
    if (is_of_the_machine(word)) return has_value ? 1 : 0;
    if (const auto given = std::ranges::find(reading, word); given != reading.end()) {
        const bool same = has_value && given + 1 != reading.end() && given[1] == words[i + 1];
        if (same || !has_value) return same ? 1 : 0;
        if (given + 1 == reading.end() || given[1].starts_with('-')) return 0;
    }
    pasted.left_out.push_back(has_value ? word + " " + words[i + 1] : word);
    return has_value ? 1 : 0;
}

bool is_plain(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
           std::string_view("_-+.,:/=@%").find(c) != std::string_view::npos;
}

} // namespace

std::vector<std::string> extract_words(const ViewState& state, const std::string& file,
                                       const std::vector<std::string>& reading) {
    std::vector<std::string> words = first_words("extract", file, reading, state.step);
    add_field(words, state);
    add_isovalues(words, state);
    words.insert(words.end(), {"-o", "surface.vtp"});
    return words;
}

std::vector<std::string> render_words(const ViewState& state, const std::string& file,
                                      const std::vector<std::string>& reading) {
    std::vector<std::string> words = first_words("render", file, reading, state.step);
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

Result<PastedCommand> state_of_command(std::string_view text, const std::vector<std::string>& reading) {
    const Result<std::vector<std::string>> words = shell_words(text);
    if (!words) return words.error();
    const Result<std::size_t> begin = begin_of_options(*words);
    if (!begin) return begin.error();
    PastedCommand pasted;
    constexpr double not_given = -1;
    pasted.state.boundary = not_given;
    for (std::size_t i = *begin; i < words->size(); ++i) {
        const std::string& word = (*words)[i];
        if (word == "--") break;
        if (set_flag(pasted.state, word)) continue;
        const auto [option, attached] = option_of(word);
        if (!option) {
            i += pass_over(*words, i, reading, pasted);
            continue;
        }
        if (!attached && i + 1 == words->size())
            return Error{ErrorCode::invalid_argument, fmt::format("{} takes {}", word, option->rule)};
        const std::string value = attached ? *attached : (*words)[++i];
        if (!option->set(pasted.state, value))
            return Error{ErrorCode::invalid_argument,
                         fmt::format("{} got '{}', but it takes {}", option->name, value, option->rule)};
    }
    ViewState& state = pasted.state;
    if (state.volume) state.volume->surfaces = !state.isovalues.empty();
    if (state.colored_boundary && state.field.empty() && state.isovalues.empty()) {
        state.isosurfaces = false;
        state.field = state.color_by;
    }
    if (state.boundary == not_given) state.boundary = state.colored_boundary ? 1 : boundary_by_itself(state);
    return pasted;
}

} // namespace isotet::view
