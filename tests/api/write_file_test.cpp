// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Texts and collections as files: whole or not there.
#include <atomic>
#include <filesystem>

#include <gtest/gtest.h>

#include <isotet/write_file.hpp>

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

} // namespace
} // namespace isotet::test
