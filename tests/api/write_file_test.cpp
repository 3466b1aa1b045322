// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Texts and collections as files: whole or not there.
#include <atomic>
#include <filesystem>

#include <gtest/gtest.h>

#include <isotet/write.hpp>

#include "files/sample_files.hpp"

namespace isotet::test {
namespace {

TEST(WriteText, ReplacesAFileAsAWholeOrNotAtAll) {
    const Folder folder;
    const std::string path = folder / "a.txt";
    put_content(path, "old");
    const std::atomic<bool> cancel = true;
    EXPECT_FALSE(write_text("new", path, {.progress = {.report = {}, .cancel = &cancel}}));
    EXPECT_EQ(content_of(path), "old");
    EXPECT_TRUE(write_text("new", path));
    EXPECT_EQ(content_of(path), "new");
    EXPECT_EQ(folder.entries(), 1u);
}

TEST(CheckWritable, LeavesNothingAndNamesTheReason) {
    const Folder folder;
    EXPECT_TRUE(check_writable(folder / "a.txt"));
    EXPECT_EQ(folder.entries(), 0u);
    EXPECT_EQ(check_writable(folder / "no/a.txt").error().code, ErrorCode::file);
    EXPECT_EQ(check_writable(folder.path().string()).error().code, ErrorCode::invalid_argument);
}

TEST(WriteCollection, NamesFilesRelativeToItsFolder) {
    const Folder folder;
    ASSERT_TRUE(write_collection({{0, 0, folder / "a&b.vtp"}, {0.5, 1, folder / "sub/c.vtp"}}, folder / "all.pvd"));
    const std::string text = content_of(folder / "all.pvd");
    EXPECT_NE(text.find("timestep=\"0\" group=\"\" part=\"0\" file=\"a&amp;b.vtp\""), std::string::npos) << text;
    EXPECT_NE(text.find("timestep=\"0.5\" group=\"\" part=\"1\" file=\"sub/c.vtp\""), std::string::npos) << text;
    EXPECT_EQ(folder.entries(), 1u);
}

TEST(WriteCollection, OfUsdShowsFilesOneAfterAnother) {
    const Folder folder;
    const std::string path = folder / "all.usda";
    ASSERT_TRUE(write_collection(
        {{0, 0, folder / "a.usda"}, {0, 1, folder / "b.usda"}, {7, 0, folder / "c.usda"}}, path));
    const std::string text = content_of(path);
    EXPECT_NE(text.find("@@@./a.usda@@@"), std::string::npos) << text;
    EXPECT_NE(text.find("endTimeCode = 1\n"), std::string::npos) << text;
    const std::string first = "visibility.timeSamples = { 0: \"inherited\", 1: \"invisible\" }";
    EXPECT_NE(text.find(first, text.find("b.usda")), std::string::npos) << "of one time both";
    EXPECT_NE(text.find("visibility.timeSamples = { 0: \"invisible\", 1: \"inherited\", 2: \"invisible\" }"),
              std::string::npos)
        << text;
    EXPECT_TRUE(is_written_collection(path));
    put_content(path, "#usda 1.0\n");
    EXPECT_FALSE(is_written_collection(path));
}

} // namespace
} // namespace isotet::test
