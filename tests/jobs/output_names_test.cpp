// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/jobs/output_names.hpp>

#include <filesystem>

#include <gtest/gtest.h>

#include "support/temporary_folder.hpp"

namespace isotet::jobs {
namespace {

TEST(OutputNames, FillsInIsovalueTimeAndStep) {
    EXPECT_EQ(OutputNames("a-{value}.vtp").name({0.7, {}, 0, 1}), "a-0.7.vtp");
    EXPECT_EQ(OutputNames("{time}/{value}.vtp").name({-1e-5, 2.5, 0, 1}), "2.5/-1e-05.vtp");
    EXPECT_EQ(OutputNames("s{step}.vtp").name({0, {}, 7, 101}), "s007.vtp") << "as many digits as the last one has";
    EXPECT_EQ(OutputNames("s{step}{step}.vtp").name({0, {}, 7, 10}), "s77.vtp");
}

TEST(OutputNames, KnowsWhatTheyDependOn) {
    EXPECT_TRUE(OutputNames("").none());
    EXPECT_TRUE(OutputNames("a.vtp").fixed());
    EXPECT_TRUE(OutputNames("{value}.vtp").by_value());
    EXPECT_TRUE(OutputNames("{step}.vtp").by_step());
    EXPECT_FALSE(OutputNames("{step}.vtp").by_time());
    EXPECT_TRUE(OutputNames("{time}.vtp").by_step());
}

TEST(OutputNames, CollectionLosesPlaceholdersAndWhatJoinsThem) {
    EXPECT_EQ(OutputNames("front-{time}.vtp").collection(), "front.pvd");
    EXPECT_EQ(OutputNames("{step}_front.vtp").collection(), "front.pvd");
    EXPECT_EQ(OutputNames("a.{step}.b.vtp").collection(), "a.b.pvd");
    EXPECT_EQ(OutputNames("out/{step}/{value}.vtp").collection(), "out/series.pvd") << "above the folders of the files";
}

TEST(Placeholders, ThatStandForNothingAreRefused) {
    EXPECT_TRUE(check_placeholders("x{time}{.vtp", {"{time}"}));
    const auto refused = check_placeholders("x-{val}.vtp", {"{value}", "{time}"});
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::invalid_argument);
    EXPECT_EQ(refused.error().message,
              "OUT, 'x-{val}.vtp', has {val}, but here only {value} and {time} can stand for something");
}

TEST(OutputPaths, AreNoInputAndEachDifferent) {
    const test::TemporaryFolder folder;
    const std::string input = folder.write("in.vtu", "grid");
    EXPECT_TRUE(check_output_paths({input}, {folder.file("out.vtp"), "", "-"}));
    std::filesystem::create_hard_link(input, folder.file("linked.vtu"));
    for (const std::string& same : {input, folder.file("./in.vtu"), folder.file("linked.vtu")})
        EXPECT_FALSE(check_output_paths({input}, {same})) << same;
    EXPECT_FALSE(check_output_paths({}, {folder.file("a.vtp"), folder.file("sub/../a.vtp")}));
    EXPECT_FALSE(check_output_paths({}, {folder.file("missing/a.vtp")})) << "no such folder";
}

TEST(FormatForWriting, FollowsFromTheEnding) {
    EXPECT_EQ(format_for_writing("A.VTP", Writes::surface, Compression::zlib)->name, "vtp");
    EXPECT_EQ(format_for_writing("a.vtu", Writes::grid, Compression::none)->name, "vtu");
    EXPECT_FALSE(format_for_writing("a.vtu", Writes::surface, Compression::none));
    EXPECT_FALSE(format_for_writing("a.ply", Writes::surface, Compression::lz4)) << "no compression there";
    EXPECT_FALSE(format_for_writing("a", Writes::surface, Compression::none));
}

} // namespace
} // namespace isotet::jobs
