// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Messages of a page, right and wrong.
#include <gtest/gtest.h>

#include <random>

#include "view/command_line.hpp"
#include "view/messages.hpp"
#include "view/page_words.hpp"
#include "view/random_state.hpp"

namespace isotet::test {
namespace {

using namespace view;

TEST(PageWords, NameControlsOfThePage) {
    EXPECT_EQ(view::page_words("no field was named: 'p' was taken (its name); `field` names another"),
              "no field was named: 'p' was taken (its name); Field names another");
    EXPECT_EQ(view::page_words("12 points coincide: `merge_points` 1e-6 joins them"),
              "12 points coincide: isotet view --merge-points 1e-6 joins them");
    EXPECT_EQ(view::page_words("a field '`step`' is one, it's `no option`, ` too ''"),
              "a field '`step`' is one, it's `no option`, ` too ''");
    EXPECT_EQ(view::page_words(""), "");
}

TEST(ParsePageMessage, TakesEveryKind) {
    EXPECT_EQ(std::get<HelloMessage>(*parse_page_message(R"({"do":"hello","token":"abc"})")).token, "abc");
    const auto show = std::get<ShowMessage>(*parse_page_message(
        R"({"do":"show","number":7,"moving":true,"most":900,"state":{"field":"p","isovalues":[0.5]}})"));
    EXPECT_FALSE(show.refined);
    EXPECT_TRUE(std::get<ShowMessage>(*parse_page_message(R"({"do":"refine","number":8,"state":{}})")).refined);
    EXPECT_EQ(show.number, 7U);
    EXPECT_TRUE(show.moving);
    EXPECT_EQ(show.most, 900U);
    EXPECT_EQ(show.state.isovalues, std::vector<double>{0.5});
    EXPECT_EQ(std::get<ShownMessage>(*parse_page_message(R"({"do":"shown","number":7})")).number, 7U);
    EXPECT_EQ(std::get<SpectrumMessage>(*parse_page_message(R"({"do":"spectrum","field":"p"})")).field, "p");
    EXPECT_EQ(std::get<ChartMessage>(*parse_page_message(R"({"do":"chart","field":"p"})")).field, "p");
    EXPECT_EQ(std::get<ChartMessage>(*parse_page_message(R"({"do":"chart","field":"p","step":3})")).step, 3U);
    EXPECT_EQ(std::get<ChartMessage>(*parse_page_message(R"({"do":"chart","field":"p","cells":["a=1"]})")).cells,
              std::vector<std::string>{"a=1"});
    EXPECT_EQ(std::get<SpectrumMessage>(*parse_page_message(R"({"do":"spectrum","field":"p","step":3})")).step, 3U);
    EXPECT_EQ(std::get<CommandMessage>(*parse_page_message(R"({"do":"command","state":{"field":"q"}})")).state.field,
              "q");
    EXPECT_EQ(std::get<PasteMessage>(*parse_page_message(R"({"do":"paste","text":"-i 1"})")).text, "-i 1");
}

TEST(ParsePageMessage, RefusesEverythingElse) {
    for (const char* text : {"",
                             "x",
                             "[]",
                             "null",
                             "3",
                             "{}",
                             R"({"do":3})",
                             R"({"do":"write"})",
                             R"({"do":"hello"})",
                             R"({"do":"hello","token":3})",
                             R"({"do":"show"})",
                             R"({"do":"show","number":-1,"state":{}})",
                             R"({"do":"show","number":1.5,"state":{}})",
                             R"({"do":"show","number":1})",
                             R"({"do":"show","number":1,"state":[]})",
                             R"({"do":"refine","number":1})",
                             R"({"do":"shown","number":"1"})",
                             R"({"do":"chart"})",
                             R"({"do":"chart","field":"p","step":-1})",
                             R"({"do":"chart","field":"p","cells":"a=1"})",
                             R"({"do":"show","number":1,"state":{"cells":["","","","","","","","","",""]}})",
                             R"({"do":"show","number":1,"state":{"cells":[1]}})",
                             R"({"do":"spectrum","field":"p","step":"1"})",
                             R"({"do":"paste","text":null})",
                             "{\"do\":\"hello\",\"token\":\"\xff\"}"}) {
        const auto message = parse_page_message(text);
        ASSERT_FALSE(message) << text;
        EXPECT_EQ(message.error().code, ErrorCode::invalid_argument) << text;
        EXPECT_FALSE(message.error().message.empty());
    }
}

TEST(ParsePageMessage, SurvivesDeepNesting) {
    EXPECT_FALSE(parse_page_message(std::string(60'000, '[')));
    EXPECT_FALSE(parse_page_message(std::string(30'000, '[') + std::string(30'000, ']')));
}

TEST(ParsePageMessage, SurvivesEveryTruncationAndManyChanges) {
    std::mt19937 random(1);
    for (unsigned seed = 1; seed <= 20; ++seed) {
        const std::string text =
            text_of({{"do", "show"}, {"number", seed}, {"state", to_json(random_state(seed))}, {"moving", false}});
        ASSERT_TRUE(parse_page_message(text)) << text;
        for (std::size_t length = 0; length < text.size(); ++length)
            EXPECT_FALSE(parse_page_message(std::string_view(text).substr(0, length)));
        for (int change = 0; change < 200; ++change) {
            std::string changed = text;
            changed[random() % changed.size()] = static_cast<char>(random() % 256);
            const auto message = parse_page_message(changed);
            EXPECT_TRUE(message || !message.error().message.empty());
        }
    }
}

TEST(Texts, ReplaceBytesThatAreNotUtf8) {
    EXPECT_TRUE(parse_json(error_text("file", "caf\xe9 \xff")));
    EXPECT_TRUE(parse_json(refusal_text(1, std::string("\0\x01\"\\", 4))));
}

TEST(Texts, TellTheCellsThatAChartIsOf) {
    for (const std::string& text : {chart_text({"p", {}, {"a=1"}}, 0, {}), spectrum_text({"p", {}, {"a=1"}}, 0, {})})
        EXPECT_EQ((*parse_json(text))["cells"], Json::array({"a=1"}));
    EXPECT_EQ((*parse_json(chart_text({"p"}, 0, {})))["cells"], Json::array());
}

TEST(ParsePageMessage, RefusesPicksPicturesAndFilesThatMakeNoSense) {
    for (
        const char* text : {
            R"({"do":"pick","state":{"isovalues":[1]},"point":[1,2]})",
            R"({"do":"pick","state":{"isovalues":[1]},"point":[1,2,"3"]})",
            R"({"do":"pick","state":{},"point":[1,2,3]})", R"({"do":"parts","state":{}})",
            R"({"do":"share","field":"p","of":"volume"})", R"({"do":"share","of":"points","percent":5})",
            R"({"do":"share","field":"p","of":"area","percent":5})",
            R"({"do":"pick","state":{"isovalues":[1]},"slice":0,"point":[1,2,3]})",
            R"({"do":"show","number":1,"state":{},"picture":[0,10]})",
            R"({"do":"show","number":1,"state":{},"picture":[10,8193]})",
            R"({"do":"show","number":1,"state":{},"picture":[10]})",
            R"({"do":"show","number":1,"state":{"boundary":1.5}})",
            R"({"do":"show","number":1,"state":{"clips":[[0,0,0,1]]}})",
            R"({"do":"show","number":1,"state":{"slices":[[1,0,0]]}})",
            R"({"do":"show","number":1,"state":{"slices":[[1,0,0,0],[1,0,0,0],[1,0,0,0],[1,0,0,0],[1,0,0,0],[1,0,0,0],[1,0,0,0]]}})",
            R"({"do":"show","number":1,"state":{"step":-1}})",
            R"({"do":"save","kind":"program","name":"a.png","state":{}})",
            R"({"do":"save","kind":"picture","state":{}})",
            R"({"do":"save","kind":"picture","name":"a.png","width":-1,"state":{}})",
            R"({"do":"save","kind":"sweep","name":"a.webp","from":"1","state":{}})",
        })
        EXPECT_FALSE(parse_page_message(text)) << text;
    EXPECT_TRUE(parse_page_message(R"({"do":"pick","state":{"slices":[[1,0,0,0]]},"slice":0,"point":[1,2,3]})"));
    EXPECT_TRUE(parse_page_message(R"({"do":"save","kind":"turn","name":"a.webp","pictures":8,"state":{}})"));
}

SaveRequest picture_request(std::string name) {
    SaveRequest request;
    request.name = std::move(name);
    request.state.isovalues = {0.5};
    return request;
}

TEST(SaveWords, NameOneFileOfTheFolderAndNothingElse) {
    const std::string folder = "/out";
    for (const char* name : {"", "../a.png", "a/b.png", "/etc/a.png", ".a.png", "a.png\n", "a\0.png", "a;b.png",
                             "-.vtp", "a", "a.exe", "a.PNG"})
        EXPECT_FALSE(save_words(picture_request(name), folder, "grid.vtu", {})) << name;
    EXPECT_FALSE(is_file_name(std::string(101, 'a')));
    const auto words = save_words(picture_request("-a b.png"), folder, "grid.vtu", {});
    ASSERT_TRUE(words) << words.error().message;
    EXPECT_EQ(words->back(), "/out/-a b.png");
    EXPECT_EQ((*words)[1], "render");
}

TEST(SaveWords, SweepsReplaceTheIsovaluesAndTurnsKeepThem) {
    SaveRequest request = picture_request("a.webp");
    request.kind = SaveKind::sweep;
    request.from = -1;
    request.to = 2;
    request.pictures = 5;
    const std::string sweep = shell_text(save_words(request, "out", "grid.vtu", {}).value());
    EXPECT_NE(sweep.find("--sweep=-1,2,5"), std::string::npos) << sweep;
    EXPECT_EQ(sweep.find("--isovalue"), std::string::npos) << sweep;
    request.state.volume = VolumeState{"0:0,1:1"};
    const std::string peak = shell_text(save_words(request, "out", "grid.vtu", {}).value());
    EXPECT_NE(peak.find("--volume --opacity peaks"), std::string::npos) << "a sweep says where the peak is: " << peak;
    request.state.volume.reset();
    request.kind = SaveKind::turn;
    const std::string turn = shell_text(save_words(request, "out", "grid.vtu", {}).value());
    EXPECT_NE(turn.find("--orbit=5"), std::string::npos) << turn;
    EXPECT_NE(turn.find("--isovalue 0.5"), std::string::npos) << turn;
}

TEST(SaveWords, StepsReplaceTheStepAndSolidsAreSurfaces) {
    SaveRequest request = picture_request("a.webp");
    request.kind = SaveKind::steps;
    request.state.step = 3;
    const std::string steps = shell_text(save_words(request, "out", "grid.vtu", {}).value());
    EXPECT_NE(steps.find("--all-steps"), std::string::npos) << steps;
    EXPECT_EQ(steps.find("--step "), std::string::npos) << steps;
    request.kind = SaveKind::series;
    EXPECT_FALSE(save_words(request, "out", "grid.vtu", {}));
    request.name = "a.glb";
    const std::string series = shell_text(save_words(request, "out", "grid.vtu", {}).value());
    EXPECT_NE(series.find("isotet extract"), std::string::npos) << series;
    EXPECT_TRUE(series.ends_with("--all-steps -q -o out/a.glb")) << series;
    EXPECT_EQ(series.find("--step "), std::string::npos) << series;
    request.name = "a.webp";
    request.kind = SaveKind::below;
    EXPECT_FALSE(save_words(request, "out", "grid.vtu", {}));
    request.name = "a.stl";
    const std::string solid = shell_text(save_words(request, "out", "grid.vtu", {}).value());
    EXPECT_NE(solid.find("isotet extract"), std::string::npos) << solid;
    EXPECT_NE(solid.find("--solid below"), std::string::npos) << solid;
    EXPECT_NE(solid.find("--step 3"), std::string::npos) << solid;
    EXPECT_EQ(solid.find("--size"), std::string::npos) << solid;
    request.state.solid = SolidSide::above;
    for (const char* name : {"a.stl", "a.3mf", "a.glb", "a.usda"}) {
        request.name = name;
        request.kind = SaveKind::below;
        const std::string below = shell_text(save_words(request, "out", "grid.vtu", {}).value());
        EXPECT_NE(below.find("--solid below"), std::string::npos) << below;
        EXPECT_EQ(below.find("--solid above"), std::string::npos) << below;
        request.kind = SaveKind::surface;
        const std::string shown = shell_text(save_words(request, "out", "grid.vtu", {}).value());
        EXPECT_NE(shown.find("--solid above"), std::string::npos) << shown;
    }
}

TEST(SaveWords, NumbersOfPartsAreNotThoseOfAnotherSolid) {
    SaveRequest request;
    request.name = "s.stl";
    request.state.isovalues = {0.5};
    request.state.solid = SolidSide::above;
    const auto keeps = [&](SaveKind kind, const char* choice) {
        request.kind = kind;
        request.state.keep = parse_part_choice(choice);
        const auto words = save_words(request, "/folder", "grid.vtu", {}).value();
        return std::ranges::find(words, "--keep") != words.end();
    };
    for (const char* choice : {"parts:0", "not:1"}) {
        EXPECT_TRUE(keeps(SaveKind::surface, choice) && keeps(SaveKind::above, choice));
        EXPECT_FALSE(keeps(SaveKind::below, choice));
    }
    EXPECT_TRUE(keeps(SaveKind::below, "largest"));
}

TEST(SaveWords, PicturesHaveASize) {
    SaveRequest request = picture_request("a.png");
    request.width = 0;
    EXPECT_FALSE(save_words(request, "out", "grid.vtu", {}));
    request.width = 100'000;
    EXPECT_FALSE(save_words(request, "out", "grid.vtu", {}));
}

} // namespace
} // namespace isotet::test
