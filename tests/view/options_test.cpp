// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The command lines of the page are those that the program takes: they are parsed by its own option tree.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "options/option_tree.hpp"
#include "options/options.hpp"
#include "view/command_line.hpp"
#include "view/page_words.hpp"
#include "view/random_state.hpp"

namespace isotet::test {
namespace {

using view::ViewState;

void expect_same_planes(const std::vector<Plane>& a, const std::vector<Plane>& b) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
        EXPECT_EQ(a[i].normal, b[i].normal);
        EXPECT_EQ(a[i].offset, b[i].offset);
    }
}

void expect_same_volume(const cli::RenderCommand& render, const std::optional<view::VolumeState>& volume) {
    ASSERT_EQ(render.volume, volume.has_value());
    ASSERT_EQ(render.volume_opacity.has_value(), volume.has_value());
    if (!volume) return;
    const OpacityText opacity = parse_opacity(volume->opacity).value();
    EXPECT_EQ(render.volume_opacity->curve.points, opacity.curve.points);
    EXPECT_EQ(render.volume_opacity->preset, opacity.preset);
    EXPECT_EQ(render.volume_opacity->peaks, opacity.peaks);
    EXPECT_EQ(render.opacity_length, volume->length);
    EXPECT_EQ(render.volume_shading, volume->shaded);
}

/// Names without their dashes in front, but --help.
std::set<std::string> options_of(const std::vector<cli::OptionText>& options) {
    std::set<std::string> names;
    for (const cli::OptionText& option : options)
        for (const std::string& flag : option.flags)
            if (flag.starts_with("--") && !flag.starts_with("--help")) names.insert(flag.substr(2));
    return names;
}

TEST(PageWords, NameOptionsOfIsotetViewThatItHas) {
    cli::CommandLine line;
    const cli::OptionTree tree(line);
    const std::set<std::string> of_view = options_of(tree.describe("view").options);
    std::size_t named = 0;
    for (const cli::CommandText& command : tree.describe_all())
        for (const std::string& name : options_of(command.options)) {
            std::string option = name;
            std::ranges::replace(option, '-', '_');
            const std::string marked = "`" + option + "`", words = view::page_words(marked);
            const bool is_view = words.starts_with("isotet view --");
            EXPECT_TRUE(!is_view || words == "isotet view --" + name) << words;
            EXPECT_TRUE(of_view.contains(name) ? words != marked : !is_view) << name << ": " << words;
            named += is_view;
        }
    EXPECT_GT(named, 10u);
}

TEST(PageWords, NameControlsAndLeaveOtherWords) {
    EXPECT_EQ(
        view::page_words("the file has 3 time steps: step 0, time 0, was taken; `time` and `step` choose another"),
        "the file has 3 time steps: step 0, time 0, was taken; Time and Time step choose another");
    EXPECT_EQ(view::page_words("`merge_points` joins them"), "isotet view --merge-points joins them");
    EXPECT_EQ(view::page_words("`max_size` would be larger"), "`max_size` would be larger");
    EXPECT_EQ(view::page_words("'a `field` of mine' has no `field`"), "'a `field` of mine' has no Field");
}

TEST(RenderWords, AreOptionsOfTheProgramWithTheSameMeaning) {
    for (unsigned seed = 1; seed <= 200; ++seed) {
        SCOPED_TRACE(seed);
        const ViewState state = random_state(seed);
        cli::CommandLine line;
        cli::OptionTree tree(line);
        const auto parsed = tree.parse(view::render_words(state, "grid.vtu", {"--keep-pieces"}));
        ASSERT_TRUE(parsed) << parsed.error().message;
        const cli::RenderCommand& render = line.render;
        EXPECT_EQ(line.command, "render");
        EXPECT_EQ(render.grid.file, "grid.vtu");
        EXPECT_TRUE(render.grid.keep_pieces);
        EXPECT_EQ(render.grid.step, state.step);
        EXPECT_EQ(render.grid.cells, state.cells);
        EXPECT_EQ(render.boundary.value_or(state.volume ? 0 : view::default_boundary_opacity), state.boundary);
        expect_same_volume(render, state.volume);
        EXPECT_EQ(render.edges, state.edges);
        EXPECT_EQ(render.stretch, state.stretch ? std::vector<double>(state.stretch->begin(), state.stretch->end())
                                                : std::vector<double>());
        EXPECT_EQ(render.solid, state.solid);
        EXPECT_EQ(render.keep, state.keep);
        expect_same_planes(render.clips, state.clips);
        expect_same_planes(render.slices, state.slices);
        EXPECT_EQ(render.field.name, state.field);
        EXPECT_EQ(render.isovalues, state.isovalues);
        EXPECT_EQ(render.color_by, state.color_by);
        EXPECT_EQ(render.scale.map, state.map);
        EXPECT_EQ(render.scale.logarithmic, state.logarithmic);
        EXPECT_EQ(render.opacity, state.opacity);
        EXPECT_EQ(render.outline, state.outline);
        EXPECT_EQ(render.range,
                  state.range ? (std::vector<double>{state.range->lower, state.range->upper}) : std::vector<double>());
        EXPECT_EQ(render.camera ? to_text(*render.camera) : "", state.camera ? to_text(*state.camera) : "");
    }
}

TEST(ExtractWords, AreOptionsOfTheProgramWithTheSameMeaning) {
    for (unsigned seed = 1; seed <= 100; ++seed) {
        SCOPED_TRACE(seed);
        const ViewState state = random_state(seed);
        cli::CommandLine line;
        cli::OptionTree tree(line);
        const auto parsed = tree.parse(view::extract_words(state, "-grid.vtu"));
        ASSERT_TRUE(parsed) << parsed.error().message;
        EXPECT_EQ(line.command, "extract");
        EXPECT_EQ(line.extract.grid.file, "./-grid.vtu");
        EXPECT_EQ(line.extract.field.name, state.field);
        EXPECT_EQ(line.extract.grid.cells, state.cells);
        EXPECT_EQ(line.extract.isovalues, state.isovalues);
        EXPECT_EQ(line.extract.keep, state.keep);
        EXPECT_EQ(line.extract.out, "surface.vtp");
        EXPECT_EQ(line.extract.grid.step, state.step);
        cli::CommandLine of_all;
        const auto all = cli::OptionTree(of_all).parse(view::extract_all_words(state, "grid.vtu"));
        ASSERT_TRUE(all) << all.error().message;
        EXPECT_EQ(of_all.extract.out, "surface-{step}.vtp");
        EXPECT_EQ(of_all.extract.isovalues, state.isovalues);
        EXPECT_TRUE(of_all.extract.all_steps && !of_all.extract.grid.step);
    }
}

} // namespace
} // namespace isotet::test
