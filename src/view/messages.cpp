// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "view/messages.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <new>

#include <fmt/format.h>

#include "view/page_words.hpp"

namespace isotet::view {

namespace {

Error wrong_message(std::string_view sentence) {
    return {ErrorCode::invalid_argument, fmt::format("a message of the page: {}", sentence)};
}

/// A text of a message; nothing where it is none or too long.
std::optional<std::string> message_text(const Json& json, std::string_view key, std::size_t most) {
    const Json* value = find(json, key);
    const std::string* found = value ? text(*value) : nullptr;
    if (!found || found->size() > most) return std::nullopt;
    return *found;
}

Result<ViewState> message_state(const Json& json) {
    const Json* state = find(json, "state");
    if (!state) return wrong_message("\"state\" is missing");
    return state_of(*state);
}

std::optional<std::uint64_t> message_number(const Json& json) {
    const Json* number = find(json, "number");
    return number ? whole_number(*number) : std::nullopt;
}

bool message_flag(const Json& json, std::string_view key) {
    const Json* flag = find(json, key);
    return flag && flag->is_boolean() && flag->get<bool>();
}

/// The field, the step and the cells that a question is about.
Result<ChartMessage> field_of_step(const Json& json) {
    auto field = message_text(json, "field", max_name_bytes);
    if (!field) return wrong_message("\"field\" takes a name");
    ChartMessage question{*std::move(field)};
    if (const Json* cells = find(json, "cells"); cells && !take_cells(*cells, question.cells))
        return wrong_message("\"cells\" takes a few texts");
    const Json* number = find(json, "step");
    const auto step = number ? whole_number(*number) : std::nullopt;
    if (number && !step) return wrong_message("\"step\" takes a whole number");
    question.step = step;
    return question;
}

Result<PageMessage> parse_show(const Json& json, bool refined) {
    const auto number = message_number(json);
    if (!number) return wrong_message("\"number\" takes a whole number");
    Result<ViewState> state = message_state(json);
    if (!state) return state.error();
    ShowMessage message;
    message.number = *number;
    message.state = *std::move(state);
    message.refined = refined;
    message.moving = message_flag(json, "moving");
    if (const Json* most = find(json, "most")) message.most = whole_number(*most);
    if (const Json* next = find(json, "next")) message.next = whole_number(*next);
    if (const Json* picture = find(json, "picture")) {
        constexpr std::uint64_t max_side = 8192;
        const bool two = picture->is_array() && picture->size() == 2;
        const auto width = two ? whole_number((*picture)[0]) : std::nullopt;
        const auto height = two ? whole_number((*picture)[1]) : std::nullopt;
        if (!width || !height || *width < 1 || *height < 1 || *width > max_side || *height > max_side)
            return wrong_message("\"picture\" takes a width and a height, 1 to 8192");
        message.picture = {static_cast<std::uint32_t>(*width), static_cast<std::uint32_t>(*height)};
    }
    return PageMessage(std::move(message));
}

std::optional<std::array<double, 3>> three_numbers(const Json* json) {
    if (!json || !json->is_array() || json->size() != 3) return std::nullopt;
    std::array<double, 3> numbers{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto number = finite_number((*json)[axis]);
        if (!number) return std::nullopt;
        numbers[axis] = *number;
    }
    return numbers;
}

Result<PageMessage> parse_pick(const Json& json) {
    Result<ViewState> state = message_state(json);
    if (!state) return state.error();
    PickMessage message;
    message.state = *std::move(state);
    if (const Json* slice = find(json, "slice")) {
        const auto which = whole_number(*slice);
        if (!which || *which >= message.state.slices.size()) return wrong_message("\"slice\" is none of the state");
        message.slice = *which;
    } else if (message_flag(json, "boundary")) message.boundary = true;
    else if (message.state.isovalues.empty()) return wrong_message("a pick takes an isovalue or a slice");
    const auto point = three_numbers(find(json, "point"));
    if (!point) return wrong_message("\"point\" takes three numbers");
    message.point = *point;
    if (const Json* ray = find(json, "ray")) {
        message.ray = three_numbers(ray);
        if (!message.ray) return wrong_message("\"ray\" takes three numbers");
    }
    message.parts = message_flag(json, "parts");
    return PageMessage(std::move(message));
}

Result<PageMessage> parse_parts_question(const Json& json) {
    Result<ViewState> state = message_state(json);
    if (!state) return state.error();
    if (state->isovalues.empty()) return wrong_message("parts are those of an isovalue");
    return PageMessage(PartsMessage{*std::move(state), message_flag(json, "refined")});
}

Result<PageMessage> parse_share(const Json& json) {
    const auto of = message_text(json, "of", 32);
    const Json* number = find(json, "percent");
    const auto percent = number ? finite_number(*number) : std::nullopt;
    if (!percent || (of != "volume" && of != "points"))
        return wrong_message("a share is \"of\" volume or points, and \"percent\" takes a number");
    auto question = field_of_step(json);
    if (!question) return question.error();
    auto& [field, step, cells] = *question;
    return PageMessage(ShareMessage{std::move(field),
                                    step,
                                    {of == "volume" ? IsovalueShare::Of::volume : IsovalueShare::Of::points, *percent},
                                    std::move(cells)});
}

Result<PageMessage> parse_save(const Json& json) {
    Result<ViewState> state = message_state(json);
    if (!state) return state.error();
    const auto name = message_text(json, "name", 256), kind_name = message_text(json, "kind", 32);
    const auto kind = parse_save_kind(kind_name.value_or(""));
    if (!name || !kind) return wrong_message("a file has a \"name\", and a \"kind\": picture, surface, sweep, "
                                               "turn, steps, above or below");
    SaveMessage message;
    message.download = message_flag(json, "download");
    SaveRequest& request = message.request;
    request.kind = *kind;
    request.name = *name;
    request.state = *std::move(state);
    for (const auto& [key, target] : {std::pair("width", &request.width), std::pair("height", &request.height),
                                      std::pair("pictures", &request.pictures)})
        if (const Json* value = find(json, key)) {
            const auto number = whole_number(*value);
            if (!number || *number > 100'000) return wrong_message(fmt::format("\"{}\" takes a whole number", key));
            *target = static_cast<std::uint32_t>(*number);
        }
    for (const auto& [key, target] : {std::pair("from", &request.from), std::pair("to", &request.to)})
        if (const Json* value = find(json, key)) {
            const auto number = finite_number(*value);
            if (!number) return wrong_message(fmt::format("\"{}\" takes a number", key));
            *target = *number;
        }
    return PageMessage(std::move(message));
}

Result<PageMessage> parse_known(const std::string& action, const Json& json) {
    constexpr std::size_t max_command_bytes = 32'768;
    if (action == "hello") {
        auto token = message_text(json, "token", 256);
        if (token) return PageMessage(HelloMessage{*std::move(token)});
        return wrong_message("\"token\" takes a text");
    }
    if (action == "show" || action == "refine") return parse_show(json, action == "refine");
    if (action == "shown") {
        if (const auto number = message_number(json)) return PageMessage(ShownMessage{*number});
        return wrong_message("\"number\" takes a whole number");
    }
    if (action == "chart" || action == "spectrum") {
        auto question = field_of_step(json);
        if (!question) return question.error();
        if (action == "chart") return PageMessage(*std::move(question));
        return PageMessage(SpectrumMessage{std::move(question->field), question->step, std::move(question->cells)});
    }
    if (action == "command") {
        Result<ViewState> state = message_state(json);
        if (!state) return state.error();
        return PageMessage(CommandMessage{*std::move(state)});
    }
    if (action == "paste") {
        auto command = message_text(json, "text", max_command_bytes);
        if (command) return PageMessage(PasteMessage{*std::move(command)});
        return wrong_message("\"text\" takes a command line");
    }
    if (action == "pick") return parse_pick(json);
    if (action == "save") return parse_save(json);
    if (action == "parts") return parse_parts_question(json);
    if (action == "share") return parse_share(json);
    if (action == "part") return PageMessage(PartMessage{});
    return wrong_message("\"do\" is none of hello, show, refine, shown, chart, spectrum, command, paste, pick, "
                         "parts, share, save, part");
}

double milliseconds(double seconds) { return std::round(seconds * 1e5) / 100; }

Json corner_json(const std::array<double, 3>& corner) { return {corner[0], corner[1], corner[2]}; }

Json surface_json(const FrameSurface& surface, Blocks& blocks) {
    Json json = {{"key", surface.key},
                 {"isovalue", surface.isovalue},
                 {"color", color_text(surface.color)},
                 {"triangles", surface.triangles},
                 {"opacity", surface.opacity},
                 {"kind", surface.kind}};
    if (!surface.mesh) return json;
    const Mesh& mesh = *surface.mesh;
    const MeshPlaces places = add_mesh(mesh, blocks);
    Json& drawn = json["mesh"];
    drawn = {
        {"vertices", mesh.vertices.size()}, {"triangles", mesh.triangle_count()}, {"vertices_at", places.vertices}};
    if (!mesh.flat) drawn["corners_at"] = places.corners;
    drawn["wide"] = places.wide;
    if (places.colors) drawn["colors_at"] = *places.colors;
    if (!mesh.box.empty()) {
        drawn["lower"] = corner_json(mesh.box.lower);
        drawn["upper"] = corner_json(mesh.box.upper);
    }
    return json;
}

} // namespace

Result<PageMessage> parse_page_message(std::string_view message) {
    try {
        const std::optional<Json> json = parse_json(message);
        if (!json) return wrong_message("it is not JSON");
        const auto action = message_text(*json, "do", 32);
        if (!action) return wrong_message("\"do\" is missing");
        return parse_known(*action, *json);
    } catch (const std::bad_alloc&) {
        return Error{ErrorCode::out_of_memory, "there is too little memory for a message of the page"};
    }
}

std::string color_text(const Color& color) {
    const auto part = [](float value) { return std::lround(std::clamp(value, 0.0F, 1.0F) * 255); };
    return fmt::format("#{:02x}{:02x}{:02x}", part(color.red), part(color.green), part(color.blue));
}

Json scale_json(const ColorScale& scale, const std::vector<std::string>& classes) {
    Json json = {{"lower", scale.lower},
                 {"upper", scale.upper},
                 {"logarithmic", scale.logarithmic},
                 {"no_data", color_text(scale.no_data)}};
    for (std::size_t i = 0; i < scale.classes.size(); ++i)
        json["classes"].push_back(
            {{"name", i < classes.size() ? classes[i] : std::to_string(i)}, {"color", color_text(scale.classes[i])}});
    return json;
}

std::string frame_bytes(const FrameFacts& facts, const std::vector<FrameSurface>& surfaces) {
    Blocks blocks;
    Json notes = Json::array();
    for (const std::string& note : facts.notes) notes.push_back(page_words(note));
    Json head = {{"number", facts.number},
                 {"preview", facts.preview},
                 {"method", facts.method},
                 {"extract_ms", milliseconds(facts.extract_seconds)},
                 {"mesh_ms", milliseconds(facts.mesh_seconds)},
                 {"wait_ms", milliseconds(facts.wait_seconds)},
                 {"step", facts.step},
                 {"field", facts.field},
                 {"notes", std::move(notes)}};
    if (facts.range) head["range"] = {facts.range->lower, facts.range->upper};
    if (facts.field_bound) head["field_bound"] = *facts.field_bound;
    if (facts.scale) head["scale"] = scale_json(*facts.scale, facts.classes);
    if (facts.opacity_length > 0) {
        Json& points = head["opacity"] = Json::array();
        for (const auto& [value, opacity] : facts.opacity) points.push_back({value, opacity});
        head["opacity_length"] = facts.opacity_length;
    }
    Json& list = head["surfaces"] = Json::array();
    for (const FrameSurface& surface : surfaces) list.push_back(surface_json(surface, blocks));
    if (facts.picture) {
        const auto& [width, height, type, coded] = *facts.picture;
        const std::size_t at = blocks.add(std::vector<char>(coded.begin(), coded.end()));
        head["picture"] = {{"width", width}, {"height", height}, {"type", type}, {"at", at}, {"bytes", coded.size()}};
    }
    const std::string text = text_of(head);
    const auto head_bytes = static_cast<std::uint32_t>(text.size());
    std::string bytes;
    bytes.reserve(text.size() + blocks.bytes().size() + 16);
    bytes += "isof";
    bytes.append(reinterpret_cast<const char*>(&head_bytes), sizeof(head_bytes));
    bytes += text;
    bytes.resize((bytes.size() + 7) / 8 * 8);
    bytes += blocks.bytes();
    return bytes;
}

std::string part_bytes(std::string_view bytes) { return "isod" + std::string(bytes); }

std::string progress_text(std::string_view step, double fraction) {
    return text_of({{"say", "progress"}, {"step", step}, {"fraction", fraction}});
}

std::string refusal_text(std::uint64_t number, std::string_view sentence) {
    return text_of({{"say", "refused"}, {"number", number}, {"sentence", page_words(sentence)}});
}

std::string error_text(std::string_view about, std::string_view sentence) {
    return text_of({{"say", "error"}, {"about", about}, {"sentence", page_words(sentence)}});
}

std::string picked_text(const Picked& picked) {
    Json json = {{"say", "picked"}, {"point", corner_json(picked.point)}, {"values", Json::array()}};
    for (const auto& [name, cell, values] : picked.values)
        json["values"].push_back({{"name", name}, {"cell", cell}, {"values", values}});
    if (picked.cell) json["cell"] = *picked.cell;
    if (picked.isovalue) json["isovalue"] = *picked.isovalue;
    if (picked.boundary) json["boundary"] = true;
    return text_of(json);
}

std::string pasted_text(const PastedCommand& pasted, bool of_other_file) {
    Json json = {{"say", "state"},
                 {"state", to_json(pasted.state)},
                 {"left_out", pasted.left_out},
                 {"other_file", of_other_file ? pasted.file : std::string()}};
    if (pasted.look) {
        const auto& [camera, up, zoom] = *pasted.look;
        json["look"] = {{"direction", corner_json(camera.direction)},
                        {"up", corner_json(camera.up)},
                        {"axis", up},
                        {"parallel", camera.projection == Projection::parallel},
                        {"zoom", zoom}};
    }
    return text_of(json);
}

std::string chart_text(const ChartMessage& asked, std::size_t step, const Chart& chart) {
    return text_of({{"say", "chart"},
                    {"field", asked.field},
                    {"step", step},
                    {"cells", asked.cells},
                    {"lower", chart.lower},
                    {"upper", chart.upper},
                    {"points", chart.points},
                    {"triangles", chart.triangles},
                    {"first", chart.first},
                    {"no_data", chart.no_data}});
}

std::string parts_text(const PartsMessage& message, std::size_t step, const std::vector<SurfacePart>& parts,
                       const std::vector<std::uint64_t>& kept) {
    constexpr std::size_t most = 500;
    Json rows = Json::array();
    for (std::size_t i = 0; i < std::min(most, parts.size()); ++i)
        rows.push_back({{"triangles", parts[i].triangles},
                        {"area", parts[i].area},
                        {"volume", parts[i].closed ? Json(parts[i].volume) : Json()},
                        {"kept", std::ranges::binary_search(kept, i)}});
    return text_of({{"say", "parts"},
                    {"field", message.state.field},
                    {"step", step},
                    {"isovalue", message.state.isovalues.front()},
                    {"solid", message.state.solid ? name_of(*message.state.solid) : ""},
                    {"keep", message.state.keep ? to_text(*message.state.keep) : ""},
                    {"count", parts.size()},
                    {"kept", kept.size()},
                    {"parts", std::move(rows)}});
}

std::string share_text(const ShareMessage& message, std::size_t step, double isovalue) {
    return text_of({{"say", "share"},
                    {"field", message.field},
                    {"step", step},
                    {"of", message.share.of == IsovalueShare::Of::volume ? "volume" : "points"},
                    {"percent", message.share.percent},
                    {"isovalue", isovalue}});
}

std::string spectrum_text(const SpectrumMessage& asked, std::size_t step, const ContourSpectrum& spectrum) {
    return text_of({{"say", "spectrum"},
                    {"field", asked.field},
                    {"step", step},
                    {"cells", asked.cells},
                    {"isovalues", spectrum.isovalues},
                    {"area", spectrum.area},
                    {"volume_below", spectrum.volume_below},
                    {"volume", spectrum.volume}});
}

} // namespace isotet::view
