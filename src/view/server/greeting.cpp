// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "view/server/greeting.hpp"

#include <utility>

#include "view/page_words.hpp"

namespace isotet::view {

namespace {

/// 64 colours of each map, "rrggbb" one after another.
Json maps_json() {
    constexpr int colors = 64;
    Json maps = Json::object();
    for (const ColorMap map :
         {ColorMap::viridis, ColorMap::cividis, ColorMap::plasma, ColorMap::turbo, ColorMap::cool_warm}) {
        std::string text;
        for (int i = 0; i < colors; ++i) text += color_text(color_at(map, i / (colors - 1.0))).substr(1);
        maps[std::string(name_of(map))] = text;
    }
    return maps;
}

} // namespace

void take_first_view(const FirstView& first, ViewState& state) {
    state.field = first.field.empty() ? std::string("x") : first.field;
    if (first.draw == FirstDraw::isosurfaces) return;
    state.boundary = 1;
    state.isosurfaces = false;
    state.color_by = first.field;
    state.colored_boundary = !first.field.empty();
}

Json welcome_json(const std::string& file, const std::string& version, const std::string& out,
                  const std::string& other) {
    Json welcome = {{"say", "welcome"}, {"version", version}, {"file", file}, {"maps", maps_json()}, {"out", out}};
    if (!other.empty()) welcome["other"] = other;
    return welcome;
}

Json grid_json(const GridView& view, const std::string& file, const ViewerInput& input) {
    Json fields = Json::array();
    for (const OfferedField& field : view.fields())
        fields.push_back({{"name", field.name}, {"cell", field.association == Association::cell}});
    Json notes = Json::array();
    for (const std::string& note : input.notes) notes.push_back(page_words(note));
    Json grid = {{"say", "grid"},
                 {"file", file},
                 {"points", view.points()},
                 {"cells", view.cells()},
                 {"fields", std::move(fields)},
                 {"state", to_json(input.state)},
                 {"notes", std::move(notes)},
                 {"times", input.times},
                 {"refines", view.refines()}};
    const Box& box = view.bounds();
    if (!box.empty()) {
        grid["lower"] = {box.lower[0], box.lower[1], box.lower[2]};
        grid["upper"] = {box.upper[0], box.upper[1], box.upper[2]};
    }
    return grid;
}

} // namespace isotet::view
