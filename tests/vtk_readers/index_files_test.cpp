// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// PVTU and PVD: files that name other files, and what they must not name.
#include <gtest/gtest.h>

#include <isotet/read.hpp>

#include "vtk_readers/sample_grid.hpp"
#include "support/temporary_folder.hpp"

namespace isotet::test {
namespace {

std::string pvtu(std::initializer_list<std::string_view> pieces) {
    std::string text = "<VTKFile type=\"PUnstructuredGrid\"><PUnstructuredGrid GhostLevel=\"0\">\n";
    for (const auto piece : pieces) text += "<Piece Source=\"" + std::string(piece) + "\"/>\n";
    return text + "</PUnstructuredGrid></VTKFile>\n";
}

std::string pvd(std::initializer_list<std::pair<std::string_view, std::string_view>> entries) {
    std::string text = "<VTKFile type=\"Collection\"><Collection>\n";
    for (const auto& [time, file] : entries)
        text += "<DataSet timestep=\"" + std::string(time) + "\" part=\"0\" file=\"" + std::string(file) + "\"/>\n";
    return text + "</Collection></VTKFile>\n";
}

class IndexFiles : public testing::Test {
protected:
    IndexFiles() {
        std::filesystem::create_directories(folder_.file("case/parts"));
        write_vtu(sample_grid(), folder_.file("case/parts/a.vtu"), Encoding::appended_raw);
        write_vtu(sample_grid(), folder_.file("outside.vtu"), Encoding::appended_raw);
    }
    std::string error_of(std::string_view name, const std::string& content, bool allow_outside = false) {
        ReadOptions options;
        options.allow_outside = allow_outside;
        const auto result = read(folder_.write(name, content), options);
        return result ? "read" : result.error().message;
    }
    TemporaryFolder folder_;
};

TEST_F(IndexFiles, PvtuReadsItsPieces) {
    expect_sample(read(folder_.write("case/grid.pvtu", pvtu({"parts/a.vtu"}))));
    const auto twice = read(folder_.write("case/grid.pvtu", pvtu({"parts/a.vtu", "parts/a.vtu"})));
    ASSERT_TRUE(twice) << twice.error().message;
    EXPECT_EQ(twice->grid.points.tuples(), 14u) << "points at one place are one";
    EXPECT_EQ(twice->grid.cells.count(), 18u);
    EXPECT_EQ(twice->info.files,
              (std::vector<std::string>{folder_.file("case/parts/a.vtu"), folder_.file("case/parts/a.vtu")}));
}

TEST_F(IndexFiles, PvtuKeepsPiecesApartWhenAsked) {
    ReadOptions options;
    options.merge_pieces_by_coordinates = false;
    const auto apart = read(folder_.write("case/grid.pvtu", pvtu({"parts/a.vtu", "parts/a.vtu"})), options);
    ASSERT_TRUE(apart) << apart.error().message;
    EXPECT_EQ(apart->grid.points.tuples(), 28u);
}

TEST_F(IndexFiles, PvdSortsItsTimes) {
    const std::string path =
        folder_.write("case/run.pvd", pvd({{"2.5", "parts/a.vtu"}, {"1", "parts/a.vtu"}, {"2.5", "parts/a.vtu"}}));
    const auto info = inspect(path);
    ASSERT_TRUE(info) << info.error().message;
    EXPECT_EQ(info->times, (std::vector<double>{1, 2.5}));
    expect_sample(read(path));
    ReadOptions options;
    options.step = 1;
    const auto second = read(path, options);
    ASSERT_TRUE(second) << second.error().message;
    EXPECT_EQ(second->grid.cells.count(), 18u);
}

TEST_F(IndexFiles, OutsideOfTheFolderIsRefusedUnlessAllowed) {
    const std::string absolute = folder_.file("outside.vtu");
    for (const std::string& name : {std::string("../outside.vtu"), std::string("parts/../../outside.vtu"), absolute}) {
        EXPECT_NE(error_of("case/a.pvtu", pvtu({name})).find("only files below its own folder"), std::string::npos)
            << name;
        EXPECT_NE(error_of("case/a.pvd", pvd({{"0", name}})).find("only files below its own folder"), std::string::npos)
            << name;
        EXPECT_EQ(error_of("case/a.pvtu", pvtu({name}), true), "read");
    }
}

TEST_F(IndexFiles, LinksThatLeadOutsideAreRefused) {
    std::filesystem::create_symlink("../outside.vtu", folder_.file("case/link.vtu"));
    std::filesystem::create_directory_symlink("..", folder_.file("case/up"));
    for (const char* name : {"link.vtu", "up/outside.vtu"})
        EXPECT_NE(error_of("case/a.pvtu", pvtu({name})).find("only files below its own folder"), std::string::npos)
            << name;
}

TEST_F(IndexFiles, UrlsAreRefusedAlways) {
    for (const bool allow : {false, true})
        EXPECT_NE(error_of("case/a.pvtu", pvtu({"http://example.org/a.vtu"}), allow).find("a URL"), std::string::npos);
}

TEST_F(IndexFiles, AnIndexThatNamesItselfIsRefused) {
    EXPECT_NE(error_of("case/a.pvtu", pvtu({"a.pvtu"})).find("names itself"), std::string::npos);
    EXPECT_NE(error_of("case/a.pvd", pvd({{"0", "a.pvd"}})).find("only .vtu, .vti"), std::string::npos);
}

TEST_F(IndexFiles, APieceThatIsMissingOrNoFileIsAnErrorThatNamesIt) {
    EXPECT_NE(error_of("case/a.pvtu", pvtu({"parts/b.vtu"})).find("parts/b.vtu"), std::string::npos);
    EXPECT_NE(error_of("case/a.pvtu", pvtu({"parts"})).find("not a file"), std::string::npos);
    EXPECT_NE(error_of("case/a.pvtu", pvtu({""})).find("without a name"), std::string::npos);
    EXPECT_NE(error_of("case/a.pvtu", pvtu({})).find("no pieces"), std::string::npos);
}

TEST_F(IndexFiles, BrokenXmlAndTimesAreErrors) {
    EXPECT_NE(error_of("case/a.pvtu", pvtu({"parts/a.vtu"}).substr(0, 100)), "read");
    for (const char* time : {"x", "nan", "1e", "1,5"})
        EXPECT_NE(error_of("case/a.pvd", pvd({{time, "parts/a.vtu"}})).find("no number"), std::string::npos) << time;
}

} // namespace
} // namespace isotet::test
