// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// A command line as a state: what a page takes of it.
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <span>
#include <utility>

#include <fmt/format.h>

#include <isotet/scene.hpp>

#include "view/command_line.hpp"

namespace isotet::view {

namespace {

/// Opacity of the boundary where isotet render is told nothing of it.
double usual_boundary(const ViewState& state) { return state.volume ? 0 : default_boundary_opacity; }

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

/// What of a command line an option changes.
struct Pasting {
    PastedCommand pasted;
    std::string view; ///< of --view; empty: none
    std::optional<UpAxis> up;
    std::optional<double> zoom;
    bool parallel = false;
};

/// What a value of an option does; false: it is not one that the option takes.
using SetOption = bool (*)(Pasting& pasting, const std::string& value);

struct PageOption {
    std::string_view name, short_name;
    std::string_view rule;
    SetOption set;
};

bool set_isovalues(Pasting& pasting, const std::string& value) {
    ViewState& state = pasting.pasted.state;
    const auto numbers = numbers_of(value);
    if (!numbers || state.isovalues.size() + numbers->size() > max_isovalues) return false;
    state.isovalues.insert(state.isovalues.end(), numbers->begin(), numbers->end());
    return true;
}

bool set_range(Pasting& pasting, const std::string& value) {
    ViewState& state = pasting.pasted.state;
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
bool set_opacity(Pasting& pasting, const std::string& value) {
    ViewState& state = pasting.pasted.state;
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
     [](Pasting& pasting, const std::string& value) { return set_name(pasting.pasted.state.field, value); }},
    {"--isovalue", "-i", "numbers separated by commas, at most 32 of them", set_isovalues},
    {"--color-by", "", "a name of at most 4096 bytes",
     [](Pasting& pasting, const std::string& value) { return set_name(pasting.pasted.state.color_by, value); }},
    {"--colormap", "", "a colour map",
     [](Pasting& pasting, const std::string& value) {
         const auto map = parse_color_map(value);
         if (map) pasting.pasted.state.map = *map;
         return map.has_value();
     }},
    {"--range", "", "two numbers, the smaller one first", set_range},
    {"--opacity", "", "a number from 0 to 1; of a volume VALUE:OPACITY,VALUE:OPACITY,..., ramp, peaks or shell",
     set_opacity},
    {"--opacity-length", "", "a number above 0",
     [](Pasting& pasting, const std::string& value) {
         VolumeState& volume = volume_in(pasting.pasted.state);
         volume.length = number_of(value);
         return volume.length && *volume.length > 0;
     }},
    {"--camera", "", "a camera as isotet render tells it",
     [](Pasting& pasting, const std::string& value) {
         if (value.size() <= max_name_bytes) pasting.pasted.state.camera = parse_camera(value);
         return pasting.pasted.state.camera.has_value();
     }},
};

constexpr std::array<std::string_view, 6> axis_names{"x", "-x", "y", "-y", "z", "-z"}; ///< as UpAxis

/// "+x", "iso", or degrees to the right and upwards. Nothing: it is none of these.
std::optional<Camera> camera_of_text(const std::string& view, UpAxis up, Projection projection) {
    if (const auto named = parse_view(view)) return camera_of(*named, up, projection);
    const auto angles = numbers_of(view);
    if (!angles || angles->size() != 2 || std::abs((*angles)[1]) > 90) return std::nullopt;
    return camera_of((*angles)[0], (*angles)[1], up, projection);
}

constexpr PageOption look_options[] = {
    {"--view", "", "iso, +x, -x, +y, -y, +z, -z, or AZIMUTH,ELEVATION",
     [](Pasting& pasting, const std::string& value) {
         pasting.view = value;
         return camera_of_text(value, UpAxis::plus_z, {}).has_value();
     }},
    {"--up", "", "x, y or z, with a minus where it points downwards",
     [](Pasting& pasting, const std::string& value) {
         const auto found =
             std::ranges::find(axis_names, std::string_view(value).substr(value.starts_with('+') ? 1 : 0));
         if (found == axis_names.end()) return false;
         pasting.up = static_cast<UpAxis>(found - axis_names.begin());
         return true;
     }},
    {"--zoom", "", "a number above 0",
     [](Pasting& pasting, const std::string& value) {
         pasting.zoom = number_of(value);
         return pasting.zoom && *pasting.zoom > 0;
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

bool add_plane(std::vector<Plane>& planes, const std::string& value) {
    const auto plane = plane_of(value);
    if (!plane || planes.size() >= max_planes) return false;
    planes.push_back(*plane);
    return true;
}

/// "1,1,0@0,0,0.5": the plane across a direction through a point.
std::optional<Plane> plane_through(std::string_view text) {
    const std::size_t at = text.find('@');
    if (at == std::string_view::npos || at == 0) return {};
    const auto point = numbers_of(text.substr(at + 1));
    std::optional<Plane> plane = plane_of(std::string(text.substr(0, at)) + (text[at - 1] >= 'x' ? "=0" : ",0"));
    if (!plane || !point || point->size() != 3) return {};
    plane->offset = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) plane->offset += plane->normal[axis] * (*point)[axis];
    return plane;
}

/// All planes of --plane of isotet slice; nothing where the page has none of this kind.
std::optional<std::vector<Plane>> planes_of(const std::string& text) {
    std::vector<Plane> planes;
    if (const auto plane = text.find('@') != std::string::npos ? plane_through(text) : plane_of(text))
        planes.push_back(*plane);
    const std::size_t equals = text.find('=');
    const auto offsets =
        equals == std::string::npos ? std::nullopt : numbers_of(std::string_view(text).substr(equals + 1));
    for (std::size_t i = planes.size(); offsets && i < offsets->size(); ++i) {
        const auto plane = plane_of(fmt::format("{}={}", text.substr(0, equals), (*offsets)[i]));
        if (!plane) return {};
        planes.push_back(*plane);
    }
    return planes.empty() || planes.size() > max_planes ? std::nullopt : std::optional(std::move(planes));
}

/// Others of isotet slice that choose what is cut, such as --sphere, --along and --cylinder, are left out.
constexpr PageOption slice_options[] = {
    {"--plane", "", "planes",
     [](Pasting& pasting, const std::string& value) {
         if (auto planes = planes_of(value)) pasting.pasted.state.slices = *std::move(planes);
         else pasting.pasted.left_out.push_back("--plane " + value);
         return true;
     }},
};

constexpr std::string_view plane_rule = "x=0.5, -x=0.5 (y and z alike), or NX,NY,NZ,OFFSET, at most 6 times";

constexpr PageOption more_page_options[] = {
    {"--boundary", "", "a number from 0 to 1",
     [](Pasting& pasting, const std::string& value) {
         const auto opacity = number_of(value);
         if (opacity) pasting.pasted.state.boundary = *opacity;
         return opacity && *opacity >= 0 && *opacity <= 1;
     }},
    {"--boundary-color-by", "", "a name of at most 4096 bytes",
     [](Pasting& pasting, const std::string& value) {
         pasting.pasted.state.colored_boundary = true;
         return set_name(pasting.pasted.state.color_by, value);
     }},
    {"--clip", "", plane_rule,
     [](Pasting& pasting, const std::string& value) { return add_plane(pasting.pasted.state.clips, value); }},
    {"--slice", "", plane_rule,
     [](Pasting& pasting, const std::string& value) { return add_plane(pasting.pasted.state.slices, value); }},
    {"--solid", "", "above or below",
     [](Pasting& pasting, const std::string& value) {
         pasting.pasted.state.solid = parse_solid_side(value);
         return pasting.pasted.state.solid.has_value();
     }},
    {"--keep", "", shown_parts_rule,
     [](Pasting& pasting, const std::string& value) {
         pasting.pasted.state.keep = parse_shown_parts(value);
         return pasting.pasted.state.keep.has_value();
     }},
    {"--scale", "", "three numbers above 0",
     [](Pasting& pasting, const std::string& value) {
         const auto factors = numbers_of(value);
         if (!factors || factors->size() != 3 || !std::ranges::all_of(*factors, [](double one) { return one > 0; }))
             return false;
         pasting.pasted.state.stretch = {(*factors)[0], (*factors)[1], (*factors)[2]};
         return true;
     }},
    {"--cells", "", "FIELD=LIST, at most 8 times",
     [](Pasting& pasting, const std::string& value) {
         std::vector<std::string>& cells = pasting.pasted.state.cells;
         if (value.size() > max_name_bytes || cells.size() + 1 >= max_cell_choices) return false;
         cells.push_back(value);
         return true;
     }},
    {"--step", "", "a whole number",
     [](Pasting& pasting, const std::string& value) {
         std::uint64_t step = 0;
         const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), step);
         if (error != std::errc() || end != value.data() + value.size()) return false;
         pasting.pasted.state.step = step;
         return true;
     }},
};

/// Which options a command line has.
enum class OptionsOf : std::uint8_t { picture, slice };

const PageOption* find_option(std::string_view name, OptionsOf command) {
    const auto find_in = [&](std::span<const PageOption> options) {
        const auto found = std::ranges::find_if(options, [&](const PageOption& option) {
            return name == option.name || (!option.short_name.empty() && name == option.short_name);
        });
        return found == options.end() ? nullptr : &*found;
    };
    if (command == OptionsOf::slice)
        return name == "--step" || name == "--cells" ? find_in(more_page_options) : find_in(slice_options);
    for (const std::span<const PageOption> options :
         {std::span<const PageOption>(page_options), std::span<const PageOption>(more_page_options),
          std::span<const PageOption>(look_options)})
        if (const PageOption* found = find_in(options)) return found;
    return nullptr;
}

/// A word with its value: "--range=0,1", "-i0.5", or "--range" with the next word.
struct GivenOption {
    const PageOption* option = nullptr;
    std::optional<std::string> value;
};

GivenOption option_of(const std::string& word, OptionsOf command) {
    if (const PageOption* option = find_option(word, command)) return {option, std::nullopt};
    const std::size_t equals = word.find('=');
    if (word.starts_with("--") && equals != std::string::npos)
        return {find_option(word.substr(0, equals), command), word.substr(equals + 1)};
    if (word.size() > 2 && word[0] == '-' && word[1] != '-')
        return {find_option(word.substr(0, 2), command), word.substr(2)};
    return {};
}

bool set_flag(Pasting& pasting, std::string_view word) {
    ViewState& state = pasting.pasted.state;
    if (word == "--parallel") return pasting.parallel = true;
    if (word == "--log") return state.logarithmic = true;
    if (word == "--outline") return state.outline = true;
    if (word == "--edges") return state.edges = true;
    if (word == "--volume") {
        volume_in(state);
        return true;
    }
    if (word == "--volume-shading") return volume_in(state).shaded = true;
    return false;
}

/// Where the words behind "isotet render" begin; 0 where the first one is an option.
Result<std::size_t> begin_of_options(const std::vector<std::string>& words) {
    constexpr std::array<std::string_view, 4> commands{"render", "extract", "view", "slice"};
    const auto is_command = [&](std::size_t i) {
        return i < words.size() && std::ranges::find(commands, words[i]) != commands.end();
    };
    if (words.empty() || words[0].starts_with('-')) return std::size_t{0};
    const std::string_view program = std::string_view(words[0]).substr(words[0].rfind('/') + 1);
    if (program == "isotet" && is_command(1)) return std::size_t{2};
    if (is_command(0)) return std::size_t{1};
    if (program == "isotet" && words.size() > 1 && !words[1].starts_with('-'))
        return Error{
            ErrorCode::invalid_argument,
            fmt::format("isotet {} is not taken here, but isotet render, extract, view and slice are", words[1])};
    return Error{ErrorCode::invalid_argument,
                 fmt::format("'{}' begins no command line of isotet render, extract, view or slice", words[0])};
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

/// What a page takes that cannot be said option by option.
void finish(Pasting& pasting) {
    ViewState& state = pasting.pasted.state;
    if (state.volume) state.volume->surfaces = !state.isovalues.empty();
    if (!state.slices.empty() && state.isovalues.empty() && !state.colored_boundary && !state.volume)
        state.isosurfaces = false;
    if (state.colored_boundary && state.field.empty() && state.isovalues.empty()) {
        state.isosurfaces = false;
        state.field = state.color_by;
    }
    if (state.camera || (pasting.view.empty() && !pasting.up && !pasting.zoom && !pasting.parallel)) return;
    const UpAxis up = pasting.up.value_or(UpAxis::plus_z);
    const auto camera = camera_of_text(pasting.view.empty() ? "iso" : pasting.view, up,
                                       pasting.parallel ? Projection::parallel : Projection::perspective);
    pasting.pasted.look =
        PastedLook{*camera, std::string(axis_names[static_cast<std::size_t>(up)]), pasting.zoom.value_or(1)};
}

} // namespace

Result<PastedCommand> state_of_command(std::string_view text, const std::vector<std::string>& reading) {
    Result<std::vector<std::string>> words = shell_words(text);
    if (!words) return words.error();
    if (words->size() > 1 && words->front() == "$") words->erase(words->begin()); // the prompt that documents show
    const Result<std::size_t> begin = begin_of_options(*words);
    if (!begin) return begin.error();
    const OptionsOf command = *begin > 0 && (*words)[*begin - 1] == "slice" ? OptionsOf::slice : OptionsOf::picture;
    Pasting pasting;
    constexpr double not_given = -1;
    pasting.pasted.state.boundary = not_given;
    for (std::size_t i = *begin; i < words->size(); ++i) {
        const std::string& word = (*words)[i];
        if (word == "--") break;
        if (command == OptionsOf::picture && set_flag(pasting, word)) continue;
        const auto [option, attached] = option_of(word, command);
        if (!option) {
            i += pass_over(*words, i, reading, pasting.pasted);
            continue;
        }
        if (!attached && i + 1 == words->size())
            return Error{ErrorCode::invalid_argument, fmt::format("{} takes {}", word, option->rule)};
        const std::string value = attached ? *attached : (*words)[++i];
        if (!option->set(pasting, value))
            return Error{ErrorCode::invalid_argument,
                         fmt::format("{} got '{}', but it takes {}", option->name, value, option->rule)};
    }
    for (std::size_t i = 0; i + 1 < reading.size(); ++i) // the page's file has no other ones
        if (reading[i] == "--cells") std::erase(pasting.pasted.state.cells, reading[i + 1]);
    finish(pasting);
    ViewState& state = pasting.pasted.state;
    if (state.boundary == not_given) state.boundary = state.colored_boundary ? 1 : usual_boundary(state);
    return std::move(pasting.pasted);
}

} // namespace isotet::view
