// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// PVTU and PVD: files that name other files, and what they must not name.
#include <algorithm>

#include <fmt/core.h>
#include <gtest/gtest.h>

#include <isotet/make.hpp>
#include <isotet/read.hpp>
#include <isotet/write.hpp>

#include "vtk_readers/sample_exodus.hpp"
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
    EXPECT_EQ(twice->grid.cells.count(), 9u) << "cells that both have count once";
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

std::string time_value(std::string_view time) {
    return fmt::format("<FieldData><DataArray type='Float64' Name='TimeValue' NumberOfTuples='1' format='ascii'>{}"
                       "</DataArray></FieldData>",
                       time);
}

std::string tet_with_time(std::string_view time) {
    return "<VTKFile type='UnstructuredGrid'><UnstructuredGrid>" + (time.empty() ? std::string() : time_value(time)) +
           "<Piece NumberOfPoints='4' NumberOfCells='1'><Points><DataArray type='Float64' NumberOfComponents='3' "
           "format='ascii'>0 0 0 1 0 0 0 1 0 0 0 1</DataArray></Points><Cells>"
           "<DataArray type='Int32' Name='connectivity' format='ascii'>0 1 2 3</DataArray>"
           "<DataArray type='Int32' Name='offsets' format='ascii'>4</DataArray>"
           "<DataArray type='UInt8' Name='types' format='ascii'>10</DataArray>"
           "</Cells></Piece></UnstructuredGrid></VTKFile>";
}

TEST_F(IndexFiles, HaveTheTimeOfTheirPiecesIfItIsTheSame) {
    const auto times = [&](std::string_view first, std::string_view second) {
        folder_.write("case/a.vtu", tet_with_time(first));
        folder_.write("case/b.vtu", tet_with_time(second));
        const auto info = inspect(folder_.write("case/grid.pvtu", pvtu({"a.vtu", "b.vtu"})));
        return info ? info->times : std::vector<double>{-1};
    };
    EXPECT_EQ(times("0.5", "0.5"), std::vector<double>{0.5});
    EXPECT_EQ(times("0.5", ""), std::vector<double>{0.5});
    EXPECT_EQ(times("0.5", "0.75"), std::vector<double>{});
}

/// As OpenFOAM and VTK write it, behind the tree.
TEST_F(IndexFiles, BlocksHaveTheTimeThatTheIndexStates) {
    const std::string index = "<VTKFile type=\"vtkMultiBlockDataSet\"><vtkMultiBlockDataSet>"
                              "<DataSet name=\"a\" file=\"parts/a.vtu\"/></vtkMultiBlockDataSet>";
    const auto info = inspect(folder_.write("case/grid.vtm", index + time_value("0.125") + "</VTKFile>"));
    ASSERT_TRUE(info) << info.error().message;
    EXPECT_EQ(info->times, std::vector<double>{0.125});
}

TEST_F(IndexFiles, PvdMayHaveBlanksAroundTimes) {
    const auto info = inspect(
        folder_.write("case/run.pvd", pvd({{" 0", "parts/a.vtu"}, {"\t2.5\n", "parts/a.vtu"}, {"1 ", "parts/a.vtu"}})));
    ASSERT_TRUE(info) << info.error().message;
    EXPECT_EQ(info->times, (std::vector<double>{0, 1, 2.5}));
    EXPECT_TRUE(inspect(folder_.write("case/run.pvd", pvd({{" ", "parts/a.vtu"}})))) << "as one without a time";
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
    expect_sample(second);
}

TEST_F(IndexFiles, ByTimeMayNameFilesOfOtherFormats) {
    ExodusSample sample;
    sample.steps = 1;
    write_exodus(sample, folder_.file("case/a.e"));
    folder_.write("case/b.inp", "4 1 0 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n1 1 tet 1 2 3 4\n");
    const std::string series = R"({"file-series-version": "1.0", "files": [
        {"name": "a.e", "time": 0.5}, {"name": "b.inp", "time": 2}, {"name": "parts/a.vtu", "time": 3}]})";
    const std::size_t cells = read(folder_.file("case/a.e")).value().grid.cells.count();
    for (const std::string& path :
         {folder_.write("case/run.pvd", pvd({{"0.5", "a.e"}, {"2", "b.inp"}, {"3", "parts/a.vtu"}})),
          folder_.write("case/run.e.series", series)}) {
        SCOPED_TRACE(path);
        ReadOptions options;
        for (const std::size_t step : {0, 1, 2}) {
            options.step = step;
            const auto info = inspect(path, options);
            ASSERT_TRUE(info) << info.error().message;
            EXPECT_EQ(info->times, (std::vector<double>{0.5, 2, 3}));
            EXPECT_EQ(info->files.size(), 3u);
            const auto result = read(path, options);
            ASSERT_TRUE(result) << result.error().message;
            EXPECT_EQ(result->step, step);
            EXPECT_EQ(result->info.times, info->times);
            EXPECT_EQ(result->info.format, path.ends_with(".pvd") ? "pvd" : "series");
            if (step < 2) EXPECT_EQ(result->grid.cells.count(), step == 0 ? cells : 1);
            else expect_sample(result);
        }
    }
}

TEST_F(IndexFiles, ByTimeNameNoOthersByTimeAndNoStepsOfSeveralSteps) {
    const auto error = [&](const std::string& path) {
        const auto result = read(path);
        return result ? "read" : result.error().message;
    };
    write_exodus(ExodusSample{}, folder_.file("case/two.e"));
    EXPECT_NE(error(folder_.write("case/a.pvd", pvd({{"0", "two.e"}}))).find("2 time steps"), std::string::npos);
    folder_.write("case/b.x", pvd({{"0", "parts/a.vtu"}}));
    EXPECT_NE(error(folder_.write("case/a.pvd", pvd({{"0", "b.x"}}))).find("is an index by time, too"),
              std::string::npos);
    const std::string parts = "<VTKFile type='Collection'><Collection><DataSet timestep='0' part='0' file='two.e'/>"
                              "<DataSet timestep='0' part='1' file='parts/a.vtu'/></Collection></VTKFile>";
    EXPECT_NE(error(folder_.write("case/a.pvd", parts)).find("parts of a grid"), std::string::npos);
}

/// Grids told apart by their number of tets.
class Collections : public IndexFiles {
protected:
    Collections() {
        for (const std::uint64_t side : {1, 2, 3})
            EXPECT_TRUE(write_grid(make_grid({"kuhn", side, {"plane"}}).value(),
                                   folder_.file("t" + std::to_string(side) + ".vtu")));
    }
    /// The tets of each time, and whether a note says that entries were replaced.
    std::vector<std::size_t> tets(const std::string& entries, bool& replaced) {
        const std::string path =
            folder_.write("run.pvd", "<VTKFile type=\"Collection\"><Collection>" + entries + "</Collection></VTKFile>");
        std::vector<std::size_t> result;
        const auto info = inspect(path);
        EXPECT_TRUE(info && std::ranges::is_sorted(info->times));
        for (std::size_t step = 0; info && step < info->times.size(); ++step) {
            ReadOptions options;
            options.step = step;
            const auto grid = read(path, options);
            EXPECT_TRUE(grid) << grid.error().message;
            if (!grid) return {};
            result.push_back(grid->grid.cells.count());
            replaced = !grid->notes.empty() && grid->notes[0].find("replaced by a later one") != std::string::npos;
        }
        return result;
    }
};

std::string entry(std::string_view time, std::string_view attributes, int side) {
    return fmt::format("<DataSet timestep=\"{}\" {} file=\"t{}.vtu\"/>", time, attributes, side);
}

TEST_F(Collections, TakeTheLastEntryOfATimeGroupAndPart) {
    using Tets = std::vector<std::size_t>;
    const char* const part = "group=\"\" part=\"0\"";
    bool replaced = false;
    EXPECT_EQ(tets(entry("0", part, 1) + entry("0", part, 1) + entry("0.0", part, 1), replaced), Tets{6});
    EXPECT_TRUE(replaced);
    EXPECT_EQ(tets(entry("0.10", part, 2) + entry("1e-1", part, 1), replaced), Tets{6});
    EXPECT_TRUE(replaced);
    EXPECT_EQ(tets(entry("0", part, 1) + entry("1", part, 1) + entry("2", part, 1) + entry("1", part, 2) +
                       entry("2", part, 2) + entry("3", part, 2),
                   replaced),
              (Tets{6, 48, 48, 48}));
    EXPECT_TRUE(replaced);
    EXPECT_EQ(tets(entry("0", "part=\"0\"", 1) + entry("0", "part=\"1\"", 2), replaced), Tets{54});
    EXPECT_FALSE(replaced);
    EXPECT_EQ(tets(entry("0", "group=\"a\" part=\"0\"", 1) + entry("0", "group=\"b\" part=\"0\"", 2), replaced),
              Tets{54});
    EXPECT_FALSE(replaced);
}

TEST_F(Collections, WithoutPartsHaveFurtherFilesOrARestartedRun) {
    using Tets = std::vector<std::size_t>;
    bool replaced = false;
    EXPECT_EQ(tets(entry("0", "", 1) + entry("0", "", 2) + entry("1", "", 3), replaced), (Tets{54, 162}));
    EXPECT_FALSE(replaced);
    EXPECT_EQ(tets(entry("0", "", 1) + entry("0", "", 1), replaced), Tets{6});
    EXPECT_TRUE(replaced);
    EXPECT_EQ(tets(entry("0", "", 1) + entry("1", "", 1) + entry("0", "", 2) + entry("1", "", 3), replaced),
              (Tets{48, 162}));
    EXPECT_TRUE(replaced);
}

TEST_F(Collections, SeriesTakeTheLastFileOfATime) {
    const std::string path = folder_.write("run.vtu.series", R"({"file-series-version": "1.0", "files": [
        {"name": "t1.vtu", "time": 0}, {"name": "t1.vtu", "time": 1}, {"name": "t2.vtu", "time": 1.0}]})");
    ReadOptions options;
    options.step = 1;
    const auto second = read(path, options);
    ASSERT_TRUE(second) << second.error().message;
    EXPECT_EQ(second->grid.cells.count(), 48u);
    EXPECT_EQ(second->info.times.size(), 2u);
    EXPECT_EQ(second->notes.at(0), "1 of 3 files of the series is replaced by a later one of the same time");
}

TEST_F(Collections, SeriesTakeTimesThatAreTexts) {
    const std::string path = folder_.write("run.vtu.series", R"({"file-series-version": "1.0", "files": [
        {"name": "t1.vtu", "time": "0.5"}, {"name": "t2.vtu", "time": " 1e1 "}]})");
    EXPECT_EQ(inspect(path).value().times, (std::vector<double>{0.5, 10}));
    EXPECT_NE(inspect(folder_.write("x.vtu.series", R"({"files": [{"name": "t1.vtu", "time": "1 s"}]})"))
                  .error()
                  .message.find("no number as its \"time\""),
              std::string::npos);
}

TEST_F(Collections, SeriesWithoutTimesAreNumbered) {
    const std::string path = folder_.write("run.vtu.series", R"({"files": [{"name": "t2.vtu"}, {"name": "t1.vtu"}]})");
    ReadOptions options;
    options.step = 1;
    const auto second = read(path, options);
    ASSERT_TRUE(second) << second.error().message;
    EXPECT_EQ(second->grid.cells.count(), 6u);
    EXPECT_EQ(second->info.times, (std::vector<double>{0, 1}));
    EXPECT_EQ(second->notes.at(0), "the series has no times: the numbers of its files were taken, from 0");
}

TEST_F(IndexFiles, PiecesWithoutAPieceHaveNoCells) {
    folder_.write("case/none.vtu", "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid/></VTKFile>");
    expect_sample(read(folder_.write("case/grid.pvtu", pvtu({"none.vtu", "parts/a.vtu", "none.vtu"}))));
}

TEST_F(IndexFiles, NamesMayClimbInsideOfTheFolder) {
    expect_sample(read(folder_.write("case/grid.pvtu", pvtu({"./parts/../parts/a.vtu"}))));
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
    for (const char* name : {"link.vtu", "up/outside.vtu", "up/case/../outside.vtu"})
        EXPECT_NE(error_of("case/a.pvtu", pvtu({name})).find("only files below its own folder"), std::string::npos)
            << name;
}

TEST_F(IndexFiles, UrlsAreRefusedAlways) {
    for (const bool allow : {false, true})
        EXPECT_NE(error_of("case/a.pvtu", pvtu({"http://example.org/a.vtu"}), allow).find("a URL"), std::string::npos);
}

TEST_F(IndexFiles, AnIndexThatNamesItselfIsRefused) {
    EXPECT_NE(error_of("case/a.pvtu", pvtu({"a.pvtu"})).find("names itself"), std::string::npos);
    EXPECT_NE(error_of("case/a.pvd", pvd({{"0", "a.pvd"}})).find("names itself"), std::string::npos);
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
