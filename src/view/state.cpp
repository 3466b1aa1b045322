// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "view/state.hpp"

#include <algorithm>

#include <fmt/format.h>

#include <isotet/scene.hpp>

namespace isotet::view {

namespace {

Error wrong_state(std::string_view key, std::string_view rule) {
    return {ErrorCode::invalid_argument, fmt::format("\"{}\" of a state takes {}", key, rule)};
}

/// Reads the keys of one object; the first error stays.
class StateReader {
public:
    explicit StateReader(const Json& json) : json_(json) {}

    void read_text(const char* key, std::string& target) {
        read(key, "a text of at most 4096 bytes", [&](const Json& value) {
            const std::string* found = text(value);
            if (!found || found->size() > max_name_bytes) return false;
            target = *found;
            return true;
        });
    }
    void read_flag(const char* key, bool& target) {
        read(key, "true or false", [&](const Json& value) {
            if (!value.is_boolean()) return false;
            target = value.get<bool>();
            return true;
        });
    }
    template <class Take>
    void read(const char* key, std::string_view rule, const Take& take) {
        const Json* value = find(json_, key);
        if (!error_ && value && !take(*value)) error_ = wrong_state(key, rule);
    }
    const std::optional<Error>& error() const { return error_; }

private:
    const Json& json_;
    std::optional<Error> error_;
};

bool take_numbers(const Json& value, std::size_t most, std::vector<double>& numbers) {
    if (!value.is_array() || value.size() > most) return false;
    for (const Json& one : value) {
        const auto number = finite_number(one);
        if (!number) return false;
        numbers.push_back(*number == 0 ? 0 : *number); // -0 equals +0, and is called 0
    }
    return true;
}

bool take_planes(const Json& value, std::vector<Plane>& planes) {
    if (!value.is_array() || value.size() > max_planes) return false;
    for (const Json& one : value) {
        std::vector<double> numbers;
        if (!take_numbers(one, 4, numbers) || numbers.size() != 4) return false;
        if (numbers[0] == 0 && numbers[1] == 0 && numbers[2] == 0) return false;
        planes.push_back({{numbers[0], numbers[1], numbers[2]}, numbers[3]});
    }
    return true;
}

Json planes_json(const std::vector<Plane>& planes) {
    Json json = Json::array();
    for (const auto& [normal, offset] : planes) json.push_back({normal[0], normal[1], normal[2], offset});
    return json;
}

/// Errors   as state_of()
Result<VolumeState> volume_of(const Json& json) {
    if (!json.is_object()) return wrong_state("volume", "an object");
    VolumeState volume;
    StateReader reader(json);
    reader.read_text("opacity", volume.opacity);
    reader.read_flag("surfaces", volume.surfaces);
    reader.read_flag("shaded", volume.shaded);
    reader.read("length", "a number above 0", [&](const Json& value) {
        volume.length = finite_number(value);
        return volume.length && *volume.length > 0;
    });
    if (reader.error()) return *reader.error();
    if (const Result<OpacityText> parsed = parse_opacity(volume.opacity); !parsed) return parsed.error();
    return volume;
}

/// Three numbers above 0.
bool take_stretch(const Json& value, std::optional<std::array<double, 3>>& stretch) {
    std::vector<double> factors;
    if (!take_numbers(value, 3, factors) || factors.size() != 3) return false;
    stretch = {factors[0], factors[1], factors[2]};
    return std::ranges::all_of(factors, [](double factor) { return factor > 0; });
}

bool same_planes(const std::vector<Plane>& a, const std::vector<Plane>& b) {
    return std::ranges::equal(
        a, b, [](const Plane& p, const Plane& q) { return p.normal == q.normal && p.offset == q.offset; });
}

void read_numbers(StateReader& reader, ViewState& state) {
    reader.read("step", "a whole number", [&](const Json& value) {
        state.step = whole_number(value);
        return state.step.has_value();
    });
    reader.read("isovalues", fmt::format("at most {} finite numbers", max_isovalues),
                [&](const Json& value) { return take_numbers(value, max_isovalues, state.isovalues); });
    reader.read("stretch", "three numbers above 0",
                [&](const Json& value) { return take_stretch(value, state.stretch); });
}

void read_colors(StateReader& reader, ViewState& state) {
    reader.read("map", "the name of a colour map", [&](const Json& value) {
        const std::string* name = text(value);
        const auto map = name ? parse_color_map(*name) : std::nullopt;
        if (map) state.map = *map;
        return map.has_value();
    });
    reader.read("range", "two numbers, the smaller one first", [&](const Json& value) {
        std::vector<double> ends;
        if (!take_numbers(value, 2, ends) || ends.size() != 2 || !(ends[0] < ends[1])) return false;
        state.range = ValueRange{ends[0], ends[1]};
        return true;
    });
    reader.read("opacity", "a number from 0 to 1", [&](const Json& value) {
        state.opacity = finite_number(value);
        return state.opacity && *state.opacity >= 0 && *state.opacity <= 1;
    });
}

} // namespace

bool take_cells(const Json& json, std::vector<std::string>& cells) {
    if (!json.is_array() || json.size() > max_cell_choices) return false;
    for (const Json& one : json) {
        const std::string* choice = text(one);
        if (!choice || choice->size() > max_name_bytes) return false;
        cells.push_back(*choice);
    }
    return true;
}

std::string_view name_of(SolidSide side) { return side == SolidSide::above ? "above" : "below"; }

std::optional<SolidSide> parse_solid_side(std::string_view name) {
    for (const SolidSide side : {SolidSide::above, SolidSide::below})
        if (name == name_of(side)) return side;
    return std::nullopt;
}

std::optional<PartChoice> parse_shown_parts(std::string_view text) {
    if (text.size() > max_name_bytes) return std::nullopt;
    std::optional<PartChoice> choice = parse_part_choice(text);
    if (choice && choice->kind == PartChoice::Kind::touching && choice->region != "boundary") return std::nullopt;
    return choice;
}

bool operator==(const ViewState& a, const ViewState& b) {
    const auto range = [](const ViewState& s) {
        return s.range ? std::vector<double>{s.range->lower, s.range->upper} : std::vector<double>();
    };
    const auto camera = [](const ViewState& s) { return s.camera ? to_text(*s.camera) : std::string(); };
    return a.field == b.field && a.isovalues == b.isovalues && a.color_by == b.color_by && a.map == b.map &&
           range(a) == range(b) && a.logarithmic == b.logarithmic && a.opacity == b.opacity && a.outline == b.outline &&
           camera(a) == camera(b) && a.boundary == b.boundary && a.isosurfaces == b.isosurfaces &&
           a.colored_boundary == b.colored_boundary && a.edges == b.edges && a.solid == b.solid && a.keep == b.keep &&
           same_planes(a.clips, b.clips) && same_planes(a.slices, b.slices) && a.step == b.step && a.cells == b.cells &&
           a.volume == b.volume && a.stretch == b.stretch;
}

Json to_json(const ViewState& state) {
    Json json = {{"field", state.field},
                 {"isovalues", state.isovalues},
                 {"color_by", state.color_by},
                 {"map", name_of(state.map)},
                 {"logarithmic", state.logarithmic},
                 {"outline", state.outline},
                 {"edges", state.edges},
                 {"boundary", state.boundary},
                 {"isosurfaces", state.isosurfaces},
                 {"colored_boundary", state.colored_boundary},
                 {"clips", planes_json(state.clips)},
                 {"slices", planes_json(state.slices)}};
    if (state.solid) json["solid"] = name_of(*state.solid);
    if (state.keep) json["keep"] = to_text(*state.keep);
    if (!state.cells.empty()) json["cells"] = state.cells;
    if (state.step) json["step"] = *state.step;
    if (state.range) json["range"] = {state.range->lower, state.range->upper};
    if (state.stretch) json["stretch"] = *state.stretch;
    if (state.opacity) json["opacity"] = *state.opacity;
    if (state.camera) json["camera"] = to_text(*state.camera);
    if (state.volume) {
        json["volume"] = {{"opacity", state.volume->opacity}, {"surfaces", state.volume->surfaces}};
        if (state.volume->length) json["volume"]["length"] = *state.volume->length;
        if (state.volume->shaded) json["volume"]["shaded"] = true;
    }
    return json;
}

Result<ViewState> state_of(const Json& json) {
    if (!json.is_object()) return Error{ErrorCode::invalid_argument, "a state is an object"};
    ViewState state;
    StateReader reader(json);
    reader.read_text("field", state.field);
    reader.read_text("color_by", state.color_by);
    reader.read_flag("logarithmic", state.logarithmic);
    reader.read_flag("outline", state.outline);
    reader.read_flag("edges", state.edges);
    reader.read_flag("isosurfaces", state.isosurfaces);
    reader.read_flag("colored_boundary", state.colored_boundary);
    reader.read("boundary", "a number from 0 to 1", [&](const Json& value) {
        const auto opacity = finite_number(value);
        if (opacity) state.boundary = *opacity;
        return opacity && *opacity >= 0 && *opacity <= 1;
    });
    for (auto& [key, planes] : {std::pair("clips", &state.clips), std::pair("slices", &state.slices)})
        reader.read(key, fmt::format("at most {} planes of 4 numbers, the first three not all 0", max_planes),
                    [&](const Json& value) { return take_planes(value, *planes); });
    reader.read("solid", "above or below", [&](const Json& value) {
        const std::string* name = text(value);
        if (name) state.solid = parse_solid_side(*name);
        return state.solid.has_value();
    });
    reader.read("keep", shown_parts_rule, [&](const Json& value) {
        const std::string* choice = text(value);
        if (choice) state.keep = parse_shown_parts(*choice);
        return state.keep.has_value();
    });
    reader.read("cells", fmt::format("at most {} texts of at most 4096 bytes", max_cell_choices),
                [&](const Json& value) { return take_cells(value, state.cells); });
    read_numbers(reader, state);
    read_colors(reader, state);
    reader.read("camera", "a camera as text", [&](const Json& value) {
        const std::string* camera = text(value);
        if (camera && camera->size() <= max_name_bytes) state.camera = parse_camera(*camera);
        return state.camera.has_value();
    });
    if (reader.error()) return *reader.error();
    if (const Json* json_volume = find(json, "volume")) {
        Result<VolumeState> volume = volume_of(*json_volume);
        if (!volume) return volume.error();
        state.volume = *std::move(volume);
    }
    return state;
}

} // namespace isotet::view
