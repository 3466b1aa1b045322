// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// States as command lines and as JSON, and back.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include "view/command_line.hpp"
#include "view/random_state.hpp"

namespace isotet::test {
namespace {

using namespace view;

TEST(ShellText, IsReadBackWordByWord) {
    const std::vector<std::string> words{"isotet",    "a b",      "",  "it's", "\"quoted\"", "back\\slash",
                                         "new\nline", "$HOME;rm", "~", "é",    "*",          "'"};
    const auto back = shell_words(shell_text(words));
    ASSERT_TRUE(back) << back.error().message;
    EXPECT_EQ(*back, words);
}

TEST(ShellWords, AreTakenByTheRulesOfAShell) {
    EXPECT_EQ(*shell_words("a  \"b c\"d 'e\\f' g\\ h \\\n i"),
              (std::vector<std::string>{"a", "b cd", "e\\f", "g h", "i"}));
    EXPECT_EQ(*shell_words(R"("a\b\"\$")"), (std::vector<std::string>{R"(a\b"$)"}));
    EXPECT_FALSE(shell_words("'open"));
    EXPECT_FALSE(shell_words("\"open"));
    EXPECT_FALSE(shell_words("ends in \\"));
}

TEST(RenderWords, GiveTheStateBack) {
    for (unsigned seed = 1; seed <= 500; ++seed) {
        SCOPED_TRACE(seed);
        const ViewState state = random_state(seed);
        const auto words = render_words(state, "some grid.vtu", {"--keep-pieces"});
        const std::string text = shell_text(words);
        auto back = state_of_command(text, {"--keep-pieces"});
        ASSERT_TRUE(back) << back.error().message << "\n" << text;
        EXPECT_EQ(render_words(back->state, "some grid.vtu", {"--keep-pieces"}), words);
        back->state.isosurfaces = state.isosurfaces; // without isovalues a line does not always say
        EXPECT_TRUE(back->state == state) << text;
        EXPECT_EQ(back->file, "some grid.vtu");
        EXPECT_TRUE(back->left_out.empty()) << text;
    }
}

TEST(ExtractWords, GiveFieldAndIsovaluesBack) {
    for (unsigned seed = 1; seed <= 100; ++seed) {
        SCOPED_TRACE(seed);
        const ViewState state = random_state(seed);
        const auto back = state_of_command(shell_text(extract_words(state, "grid.vtu")));
        ASSERT_TRUE(back) << back.error().message;
        EXPECT_EQ(back->state.field, state.field);
        EXPECT_EQ(back->state.isovalues, state.isovalues);
    }
}

TEST(RenderWords, GiveTheBoundaryAloneBack) {
    ViewState state;
    state.field = state.color_by = "porosity";
    state.isosurfaces = false;
    state.colored_boundary = true;
    state.boundary = 1;
    const std::string text = shell_text(render_words(state, "grid.vtu"));
    EXPECT_EQ(text, "isotet render grid.vtu --boundary-color-by porosity -o picture.png");
    auto back = state_of_command(text);
    ASSERT_TRUE(back);
    EXPECT_TRUE(back->state == state);

    state.isosurfaces = true;
    state.isovalues = {0.25};
    back = state_of_command(shell_text(render_words(state, "grid.vtu")));
    ASSERT_TRUE(back);
    EXPECT_TRUE(back->state == state);
}

TEST(RenderWords, SayThatAxesAreNotStretched) {
    ViewState state;
    state.field = "porosity";
    state.stretch = {1, 1, 1}; // isotet render stretches flat reservoirs by itself
    const std::string text = shell_text(render_words(state, "grid.grdecl"));
    EXPECT_EQ(text, "isotet render grid.grdecl --field porosity --scale 1,1,1 -o picture.png");
}

TEST(StateJson, GivesTheStateBack) {
    for (unsigned seed = 1; seed <= 500; ++seed) {
        SCOPED_TRACE(seed);
        const ViewState state = random_state(seed);
        const auto json = parse_json(text_of(to_json(state)));
        ASSERT_TRUE(json);
        const auto back = state_of(*json);
        ASSERT_TRUE(back) << back.error().message;
        EXPECT_TRUE(*back == state);
    }
}

TEST(StateOfCommand, TakesEveryWayToWriteAnOption) {
    for (const char* text : {"isotet render g.vtu -f p -i 0.5,1", "render g.vtu --field=p -i0.5 --isovalue 1",
                             "isotet extract -i .5 -i +1 g.vtu out.vtp -f 'p' --snap", "-fp --isovalue=0.5,1e0 --",
                             "$ isotet render g.vtu -f p -i 0.5,1", "$ -f p -i 0.5,1"}) {
        const auto state = state_of_command(text);
        ASSERT_TRUE(state) << state.error().message;
        EXPECT_EQ(state->state.field, "p") << text;
        EXPECT_EQ(state->state.isovalues, (std::vector<double>{0.5, 1})) << text;
    }
}

TEST(StateOfCommand, TakesVolumesWithSurfacesAndWithout) {
    const auto both = state_of_command("isotet render g.vtu -f p --volume --opacity shell --opacity 0.5 -i 1");
    ASSERT_TRUE(both) << both.error().message;
    EXPECT_EQ(both->state.volume, (VolumeState{"shell", {}, true}));
    EXPECT_EQ(both->state.opacity, 0.5);
    EXPECT_EQ(both->state.boundary, 0) << "as isotet render has it";
    const auto alone = state_of_command("render g.vtu --volume --opacity-length 2 --boundary 0.25");
    ASSERT_TRUE(alone) << alone.error().message;
    EXPECT_EQ(alone->state.volume, (VolumeState{"ramp", 2, false}));
    EXPECT_EQ(alone->state.boundary, 0.25);
    EXPECT_EQ(state_of_command("render g.vtu -i 1")->state.boundary, default_boundary_opacity);
    for (const char* text : {"--opacity 0.5:0.1,0.4:1", "--opacity half", "--opacity-length 0", "--opacity-length"})
        EXPECT_FALSE(state_of_command(text)) << text;
}

TEST(StateOfCommand, NamesWhatItDoesNotTake) {
    const auto pasted = state_of_command(
        "isotet render x.vtu -f p -i 0.2 --view +x --zoom=2 --boundary-color-by p "
        "--scale 1,1,5 --merge-points 0 --block a --cells a=1 --cells '!b=s,2' -q --size 800x600 -o y.png",
        {"--merge-points", "0", "--block", "b", "--cells", "a=1"});
    ASSERT_TRUE(pasted) << pasted.error().message;
    EXPECT_EQ(pasted->file, "x.vtu");
    EXPECT_EQ(pasted->left_out, (std::vector<std::string>{"--block a"}));
    EXPECT_EQ(pasted->state.cells, std::vector<std::string>{"!b=s,2"}) << "the file is read with the other ones";
    EXPECT_EQ(pasted->state.stretch, (std::array<double, 3>{1, 1, 5}));
    ASSERT_TRUE(pasted->look);
    EXPECT_EQ(pasted->look->camera.direction, (std::array<double, 3>{1, 0, 0}));
    EXPECT_EQ(pasted->look->zoom, 2);
    EXPECT_EQ(pasted->look->up, "z");
    EXPECT_TRUE(pasted->state.colored_boundary);
    EXPECT_EQ(pasted->state.color_by, "p");
}

TEST(StateOfCommand, LooksAsACommandLineDoes) {
    const auto look_of = [](const char* text) { return state_of_command(text)->look; };
    EXPECT_FALSE(look_of("isotet render x.vtu -i 1"));
    EXPECT_FALSE(look_of("isotet render x.vtu --zoom 3 --camera parallel:0,0,0:0,0,1:0,1,0:2"))
        << "the camera says all";
    const auto look = look_of("isotet render x.vtu --view 90,0 --up -y --parallel");
    ASSERT_TRUE(look);
    EXPECT_EQ(look->up, "-y");
    EXPECT_EQ(look->camera.projection, Projection::parallel);
    EXPECT_EQ(to_text(look->camera), to_text(camera_of(90, 0, UpAxis::minus_y, Projection::parallel)));
    for (const char* text : {"--view left", "--view 0,91", "--up w", "--zoom 0", "--scale 1,1", "--scale 1,1,0"})
        EXPECT_FALSE(state_of_command(text)) << text;
}

TEST(StateOfCommand, TakesThePlanesOfSlices) {
    const auto slice_of = [](const char* text) { return state_of_command(text).value(); };
    const auto same = [](const Plane& plane, std::array<double, 3> normal, double offset) {
        return plane.normal == normal && std::abs(plane.offset - offset) < 1e-12;
    };
    const PastedCommand three = slice_of("isotet slice x.vtu cut.vtp --plane x=0.1,0.2,0.3 --with p --step 2");
    ASSERT_EQ(three.state.slices.size(), 3U);
    EXPECT_TRUE(same(three.state.slices[2], {1, 0, 0}, 0.3));
    EXPECT_EQ(three.file, "x.vtu");
    EXPECT_EQ(three.left_out, std::vector<std::string>{"--with p"});
    EXPECT_EQ(three.state.step, 2U);
    EXPECT_FALSE(three.state.isosurfaces);
    EXPECT_TRUE(same(slice_of("isotet slice x.vtu --plane 1,1,0@0.5,0.5,9").state.slices.at(0), {1, 1, 0}, 1));
    EXPECT_TRUE(same(slice_of("isotet slice x.vtu --plane=-z@1,2,3").state.slices.at(0), {0, 0, -1}, -3));
    EXPECT_TRUE(same(slice_of("isotet slice x.vtu --plane 0,0,2,1").state.slices.at(0), {0, 0, 2}, 1));
    for (const char* plane : {"z=50%v", "w=1", "@1,2,3", "x=1,2,3,4,5,6,7", "0,0,0@1,2,3"}) {
        const PastedCommand none = slice_of(fmt::format("isotet slice x.vtu --plane {}", plane).c_str());
        EXPECT_TRUE(none.state.slices.empty()) << plane;
        EXPECT_EQ(none.left_out, std::vector<std::string>{fmt::format("--plane {}", plane)});
        EXPECT_TRUE(none.state.isosurfaces) << "something is seen";
    }
}

TEST(StateOfCommand, DrawsIsosurfacesBesideSlicesOnlyWithIsovalues) {
    EXPECT_FALSE(state_of_command("isotet render x.vtu --slice x=1")->state.isosurfaces);
    EXPECT_TRUE(state_of_command("isotet render x.vtu --slice x=1 -i 2")->state.isosurfaces);
    EXPECT_TRUE(state_of_command("isotet render x.vtu --clip x=1")->state.isosurfaces);
}

TEST(StateOfCommand, SaysWhatIsWrong) {
    EXPECT_EQ(state_of_command("rm -rf /").error().message,
              "'rm' begins no command line of isotet render, extract, view or slice");
    EXPECT_EQ(state_of_command("isotet clip x.vtu y.vtu -f p --above 1").error().message,
              "isotet clip is not taken here, but isotet render, extract, view and slice are");
    EXPECT_FALSE(state_of_command("$"));
    EXPECT_FALSE(state_of_command("$ $ isotet render x.vtu"));
    EXPECT_EQ(state_of_command("-i 0.5,x").error().message,
              "--isovalue got '0.5,x', but it takes numbers separated by commas, at most 32 of them");
    EXPECT_EQ(state_of_command("--range 2,1").error().message,
              "--range got '2,1', but it takes two numbers, the smaller one first");
    for (const char* text : {"--keep 0", "--keep touching:steel", "-i", "-i nan", "-i inf", "--opacity 2", "--camera x", "--colormap jet", "--field"})
        EXPECT_FALSE(state_of_command(text)) << text;
}

TEST(StateOf, RefusesWhatIsNoState) {
    for (const char* text : {"[]", "3", R"({"isovalues":3})", R"({"isovalues":["a"]})", R"({"isovalues":[1e999]})",
                             R"({"field":3})", R"({"map":"jet"})", R"({"range":[1,1]})", R"({"range":[1]})",
                             R"({"opacity":-0.1})", R"({"keep":"some"})", R"({"keep":1})", R"({"keep":"touching:material=2"})", R"({"opacity":"1"})", R"({"camera":"x"})", R"({"outline":1})", R"({"volume":"ramp"})",
                             R"({"volume":{"opacity":"steep"}})", R"({"volume":{"opacity":3}})",
                             R"({"volume":{"length":0}})", R"({"volume":{"surfaces":1}})"}) {
        const auto json = parse_json(text);
        if (!json) continue; // 1e999 is no JSON number for the library
        EXPECT_FALSE(state_of(*json)) << text;
    }
    Json many = {{"isovalues", std::vector<double>(max_isovalues + 1, 0.5)}};
    EXPECT_FALSE(state_of(many));
    Json longest = {{"field", std::string(max_name_bytes + 1, 'x')}};
    EXPECT_FALSE(state_of(longest));
}

} // namespace
} // namespace isotet::test
