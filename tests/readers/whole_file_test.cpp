// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Files that change while they are read: an error or the file as it was, never the end of the process.
#include <atomic>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <isotet/read.hpp>

#include "base/system/plain_file.hpp"
#include "io/files/whole_file.hpp"
#include "readers/gmsh_sample.hpp"
#include "support/temporary_folder.hpp"

namespace isotet::test {
namespace {

using io::read_bytes;
using io::WholeFile;

TEST(WholeFile, HoldsEveryByte) {
    const TemporaryFolder folder;
    std::string content(9'000'001, 'x'); // several pieces
    for (std::size_t i = 0; i < content.size(); i += 1009) content[i] = static_cast<char>(i / 1009);
    const std::string path = folder.write("file", content);
    EXPECT_TRUE(WholeFile::read(path, {}).value().text() == content);
    EXPECT_TRUE(WholeFile::read(path, {}, 5'000'000).value().text() == content.substr(0, 5'000'000));
}

TEST(WholeFile, ReadsOnlyTheRestBehindItsBeginning) {
    const TemporaryFolder folder;
    const std::string path = folder.write("file", "abcdefgh");
    const WholeFile begin = WholeFile::read(path, {}, 3).value();
    EXPECT_FALSE(begin.is_whole());
    folder.write("file", "ABCDEFGH");
    EXPECT_EQ(WholeFile::read_rest(begin, path, {}).value().text(), "abcDEFGH");
    folder.write("file", "AB");
    EXPECT_EQ(WholeFile::read_rest(begin, path, {}).value().text(), "AB");
    const WholeFile whole = WholeFile::read(path, {}).value();
    folder.write("file", "none");
    EXPECT_EQ(WholeFile::read_rest(whole, path, {}).value().text(), "AB");
}

/// Writes other bytes over the beginning of a file, which looks as old as before.
void change_unseen(const std::string& path, std::string_view bytes) {
    const auto time = std::filesystem::last_write_time(path);
    std::fstream(path, std::ios::in | std::ios::out | std::ios::binary) << bytes;
    std::filesystem::last_write_time(path, time);
}

TEST(KeptFiles, AreReadOnceForLookingAndReading) {
    const TemporaryFolder folder;
    const std::string path = folder.write("grid.msh", gmsh_sample({}));
    ReadOptions options;
    options.kept = keep_files();
    ASSERT_TRUE(inspect(path, options));
    change_unseen(path, "no mesh");
    EXPECT_TRUE(read(path, options)) << "the bytes that inspect() read";
    EXPECT_FALSE(read(path, options)) << "they were taken";
}

TEST(KeptFiles, AreAllFilesOfAGrid) {
    const std::vector<std::vector<std::pair<std::string, std::string>>> grids{
        {{"a.mesh", "MeshVersionFormatted 2\nDimension 3\nVertices\n4\n0 0 0 0\n1 0 0 0\n0 1 0 0\n0 0 1 0\n"
                    "Tetrahedra\n1\n1 2 3 4 0\nEnd\n"},
         {"a.sol", "MeshVersionFormatted 2\nDimension 3\nSolAtVertices\n4\n1 1\n0\n1\n2\n3\nEnd\n"}},
        {{"a.node", "4 3 1 0\n0 0 0 0 7\n1 1 0 0 7\n2 0 1 0 7\n3 0 0 1 7\n"}, {"a.ele", "1 4 0\n0 0 1 2 3\n"}},
        {{"a.so", "GOCAD TSolid 1\nTVOLUME a\nVRTX 1 0 0 0\nVRTX 2 1 0 0\nVRTX 3 0 1 0\nVRTX 4 0 0 1\n"
                  "TETRA 1 2 3 4\nEND\n"}}};
    for (const auto& files : grids) {
        const TemporaryFolder folder;
        for (const auto& [name, content] : files) folder.write(name, content);
        const std::string path = folder.file(files.front().first);
        ReadOptions options;
        options.kept = keep_files();
        ASSERT_TRUE(inspect(path, options));
        ASSERT_TRUE(inspect(path, options));
        for (const auto& [name, content] : files) change_unseen(folder.file(name), "x\nx");
        options.format = files.front().first == "a.mesh" ? "medit" : files.front().first == "a.so" ? "gocad" : "tetgen";
        const auto kept = read(path, options);
        ASSERT_TRUE(kept) << kept.error().message;
        EXPECT_EQ(kept->grid.cells.count(), 1u);
        EXPECT_EQ(kept->grid.point_fields.empty(), options.format == "gocad");
        EXPECT_FALSE(read(path, options)) << "they were taken";
    }
}

TEST(KeptFiles, AreForgottenForAnotherGrid) {
    const TemporaryFolder folder;
    const std::string path = folder.write("a.msh", gmsh_sample({})), other = folder.write("b.msh", gmsh_sample({}));
    ReadOptions options;
    options.kept = keep_files();
    ASSERT_TRUE(inspect(path, options));
    ASSERT_TRUE(inspect(other, options));
    change_unseen(path, "no mesh");
    EXPECT_FALSE(read(path, options));
    EXPECT_TRUE(read(other, options));
}

TEST(KeptFiles, AreReadAgainWhereTheyWereChanged) {
    const TemporaryFolder folder;
    const std::string path = folder.write("grid.msh", gmsh_sample({}));
    ReadOptions options;
    options.kept = keep_files();
    ASSERT_TRUE(inspect(path, options));
    folder.write("grid.msh", "no mesh");
    EXPECT_FALSE(read(path, options));
}

TEST(WholeFile, ThatBecameShorterIsAnError) {
    const TemporaryFolder folder;
    const auto file = core::open_plain_file(folder.write("file", std::string(1000, 'x')));
    ASSERT_TRUE(file);
    std::vector<std::byte> room(file->size);
    EXPECT_TRUE(read_bytes(*file, "file", room, {}));
    std::filesystem::resize_file(folder.file("file"), 500);
    const auto shorter = read_bytes(*file, "file", room, {});
    ASSERT_FALSE(shorter);
    EXPECT_EQ(shorter.error().code, ErrorCode::file);
    EXPECT_EQ(shorter.error().message, "file was cut short while it was read: it had 1000 bytes");
}

TEST(WholeFile, IsNotReadAfterACancel) {
    const TemporaryFolder folder;
    const std::atomic<bool> cancel{true};
    Progress progress;
    progress.cancel = &cancel;
    const auto result = WholeFile::read(folder.write("file", "content"), progress);
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().code, ErrorCode::cancelled);
}

TEST(ReadOfAFile, ThatIsCutShortMeanwhileGivesItAsItWas) {
    constexpr int points = 200'000;
    std::string mesh = "MeshVersionFormatted 2\nDimension 3\nVertices\n" + std::to_string(points) + "\n";
    for (int i = 0; i < points; ++i)
        mesh += i == 1 ? "1 0 0 0\n" : i == 2 ? "0 1 0 0\n" : i == 3 ? "0 0 1 0\n" : "0 0 0 0\n";
    const TemporaryFolder folder;
    const std::string path = folder.write("a.mesh", mesh + "Tetrahedra\n1\n1 2 3 4 0\nEnd\n");
    bool was_cut = false;
    Progress progress;
    progress.report = [&](std::string_view, double) {
        std::filesystem::resize_file(path, 10);
        was_cut = true;
    };
    const auto result = read(path, {}, {.progress = progress});
    EXPECT_TRUE(was_cut);
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_EQ(result->grid.points.tuples(), 200'000u);
    EXPECT_EQ(result->grid.cells.count(), 1u);
}

} // namespace
} // namespace isotet::test
