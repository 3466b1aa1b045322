// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// States with everything that a state can have, from a seed.
#pragma once

#include <array>
#include <random>

#include "view/state.hpp"

namespace isotet::test {

inline view::ViewState random_state(unsigned seed) {
    std::mt19937_64 random(seed);
    const auto chance = [&](double part) { return std::uniform_real_distribution(0.0, 1.0)(random) < part; };
    const auto number = [&] {
        const double size = std::pow(10.0, std::uniform_int_distribution(-12, 12)(random));
        return std::uniform_real_distribution(-1.0, 1.0)(random) * (chance(0.5) ? 1 : size);
    };
    const auto name = [&] {
        constexpr std::string_view letters = "abcXYZ019 _-:,.'\"\\$@#=+é%()";
        std::string text;
        for (int i = std::uniform_int_distribution(1, 12)(random); i > 0; --i)
            text += letters[std::uniform_int_distribution<std::size_t>(0, letters.size() - 1)(random)];
        // A text of two bytes a letter must not be cut.
        std::erase_if(text, [](char c) { return static_cast<unsigned char>(c) >= 0x80; });
        return text.empty() ? std::string("f") : text;
    };
    view::ViewState state;
    state.field = name();
    for (int i = std::uniform_int_distribution(1, 5)(random); i > 0; --i) state.isovalues.push_back(number());
    if (chance(0.5)) state.color_by = name();
    state.map = static_cast<ColorMap>(std::uniform_int_distribution(0, 4)(random));
    if (chance(0.3)) {
        const double lower = number();
        state.range = ValueRange{lower, lower + std::abs(number()) + 1e-3 * std::abs(lower) + 1e-9};
    }
    state.logarithmic = chance(0.3);
    state.outline = chance(0.3);
    if (chance(0.5)) state.opacity = std::uniform_real_distribution(0.0, 1.0)(random);
    if (chance(0.6)) {
        Camera camera = camera_of(number(), chance(0.5) ? 30 : -20);
        if (chance(0.3)) camera.projection = Projection::parallel;
        camera.target = {number(), number(), number()};
        camera.distance = std::abs(number()) + 1e-6;
        camera.height = std::abs(number()) + 1e-6;
        state.camera = *parse_camera(to_text(camera)); // as text has it: without what the projection does not use
    }
    if (chance(0.3)) state.boundary = std::uniform_real_distribution(0.0, 1.0)(random);
    state.edges = chance(0.3);
    if (chance(0.3)) state.stretch = std::array{1.0, std::abs(number()) + 1e-12, 20.0};
    if (chance(0.3)) state.solid = chance(0.5) ? SolidSide::above : SolidSide::below;
    if (chance(0.3)) {
        constexpr std::array choices{"largest", "3", "area>0.5", "volume>1e-30", "touching:boundary", "parts:0,7", "not:2"};
        state.keep = parse_part_choice(choices[std::uniform_int_distribution<std::size_t>(0, choices.size() - 1)(random)]);
    }
    for (std::vector<Plane>* planes : {&state.clips, &state.slices})
        for (int i = std::uniform_int_distribution(0, 3)(random); i > 0; --i) {
            Plane plane{{number(), number(), number()}, number()};
            if (chance(0.5)) plane.normal = {0, chance(0.5) ? 1.0 : -1.0, 0};
            planes->push_back(plane);
        }
    if (chance(0.3)) state.cells = {"!" + name() + "=" + name(), name()};
    if (chance(0.3)) state.step = std::uniform_int_distribution<std::uint64_t>(0, 99)(random);
    if (chance(0.3)) {
        constexpr std::array texts{"ramp", "peaks", "peaks:5", "shell", "-1:0,0:0.5,0:1,1e3:0.25"};
        view::VolumeState& volume = state.volume.emplace();
        state.solid.reset(); // does not go with it
        volume.opacity = texts[std::uniform_int_distribution<std::size_t>(0, texts.size() - 1)(random)];
        volume.shaded = chance(0.3);
        if (chance(0.5)) volume.length = std::abs(number()) + 1e-9;
        if (chance(0.5)) state.isovalues.clear(); // a command line without isovalues has no surfaces
        volume.surfaces = !state.isovalues.empty();
        if (!volume.surfaces) state.keep.reset();
        if (chance(0.5)) state.color_by = state.field;
        else state.color_by.clear();
    }
    return state;
}

} // namespace isotet::test
