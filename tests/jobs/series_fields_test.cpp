// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Series whose steps have different fields: those of the steps that are asked for count.
#include <algorithm>
#include <filesystem>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <isotet/jobs/clip_files.hpp>
#include <isotet/jobs/draw_files.hpp>
#include <isotet/jobs/extract_files.hpp>
#include <isotet/jobs/grid_source.hpp>
#include <isotet/jobs/look_into.hpp>
#include <isotet/jobs/pack_file.hpp>
#include <isotet/jobs/slice_files.hpp>
#include <isotet/packed_file.hpp>
#include <isotet/paper/measure_methods.hpp>

#include "jobs/listener.hpp"
#include "support/temporary_folder.hpp"

namespace isotet::jobs {
namespace {

using test::Listener;
using Names = std::vector<std::string>;

/// A tet with point fields 0, 1, 2, 3, and a cell more where `cells` is 2.
std::string vtu(const Names& fields, int cells) {
    std::string data;
    for (const std::string& name : fields)
        data += fmt::format("<DataArray type=\"Float32\" Name=\"{}\" format=\"ascii\">0 1 2 3</DataArray>", name);
    const bool two = cells == 2;
    return fmt::format(
        "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid><Piece NumberOfPoints=\"4\" NumberOfCells=\"{}\">"
        "<PointData>{}</PointData><Points><DataArray type=\"Float32\" NumberOfComponents=\"3\">0 0 0 1 0 0 0 1 0 0 0 1"
        "</DataArray></Points><Cells><DataArray type=\"Int32\" Name=\"connectivity\">0 1 2 3 {}</DataArray>"
        "<DataArray type=\"Int32\" Name=\"offsets\">4 {}</DataArray><DataArray type=\"UInt8\" Name=\"types\">10 {}"
        "</DataArray></Cells></Piece></UnstructuredGrid></VTKFile>",
        cells, data, two ? "0 1 2" : "", two ? "7" : "", two ? "5" : "");
}

/// T at times 0, 0.5 and 1; q at 0.5 and 1; r at 1.
class SeriesFields : public testing::Test {
protected:
    void SetUp() override {
        folder.write("a.vtu", vtu({"T"}, 1));
        folder.write("b.vtu", vtu({"q", "T"}, 2));
        folder.write("c.vtu", vtu({"T", "q", "r"}, 1));
        pvd = folder.write("s.pvd", "<VTKFile type='Collection'><Collection>"
                                    "<DataSet timestep='0' file='a.vtu'/><DataSet timestep='0.5' file='b.vtu'/>"
                                    "<DataSet timestep='1' file='c.vtu'/></Collection></VTKFile>");
        series = folder.write("s.vtu.series", R"({"file-series-version": "1.0", "files": [
            {"name": "a.vtu", "time": 0}, {"name": "b.vtu", "time": 0.5}, {"name": "c.vtu", "time": 1}]})");
    }
    ExtractJob job_of(const std::string& grid, const std::string& field) const {
        ExtractJob job;
        job.grid.file = grid;
        job.field.name = field;
        job.isovalues = {1.5};
        return job;
    }
    Names files() const { return {pvd, series}; }

    test::TemporaryFolder folder;
    std::string pvd, series;
    Listener listener;
};

TEST_F(SeriesFields, AreThoseOfTheStepThatIsAskedFor) {
    for (const std::string& file : files()) {
        ExtractJob job = job_of(file, "r");
        job.grid.step = 2;
        const auto by_step = extract_files(job, listener);
        ASSERT_TRUE(by_step) << by_step.error().message;
        EXPECT_EQ(by_step->surfaces.at(0).triangles, 2u);
        job.grid.step.reset();
        job.grid.time = 1;
        EXPECT_TRUE(extract_files(job, listener));
        job.grid.time = 0.5;
        EXPECT_EQ(extract_files(job, listener).error().message, "there is no field 'r': the grid has 'q', 'T'");
        job.grid.time.reset();
        job.grid.step = 7;
        EXPECT_EQ(extract_files(job, listener).error().message,
                  "step 7 was asked for, but the file has 3 time steps, numbered from 0");
    }
}

/// A file that names the fields of all its steps at once: T in all three, which does not vary at first, q from the second on.
std::string msh_of_steps() {
    const auto data = [](const char* section, int step, const char* values) {
        return fmt::format("$NodeData\n1\n\"{0}\"\n1\n{1}\n3\n{1}\n1\n4\n{2}\n$EndNodeData\n", section, step, values);
    };
    const char* const varying = "1 0\n2 1\n3 2\n4 3";
    return "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n$EndNodes\n"
           "$Elements\n1\n1 4 0 1 2 3 4\n$EndElements\n" +
           data("T", 0, "1 7\n2 7\n3 7\n4 7") + data("T", 1, varying) + data("T", 2, varying) + data("q", 1, varying) +
           data("q", 2, varying);
}

TEST_F(SeriesFields, OfOneFileMayBeginLater) {
    const std::string file = folder.write("a.msh", msh_of_steps());
    const auto numbers = extract_files(job_of(file, "q"), listener);
    ASSERT_TRUE(numbers) << numbers.error().message;
    EXPECT_EQ(numbers->surfaces.at(0).triangles, 2u);
    ExtractJob job = job_of(file, "q");
    job.grid.step = 0;
    EXPECT_EQ(extract_files(job, listener).error().message, "there is no field 'q': the grid has 'T'");
    job.grid.step.reset();
    job.all_steps = true;
    job.out = folder.file("o_{step}.vtp");
    const auto all = extract_files(job, listener);
    ASSERT_TRUE(all) << all.error().message;
    EXPECT_EQ(all->surfaces.size(), 2u);
}

TEST_F(SeriesFields, AreLookedForByAllJobsInTheFirstStepThatHasThem) {
    const std::string note =
        "the file has 3 time steps, and step 0 has no '{}': step {}, time {}, was taken; `time` and "
        "`step` choose another";
    for (const auto& [file, field, step, time] : {std::tuple{pvd, "r", 2u, "1"},
                                                  {series, "r", 2u, "1"},
                                                  {pvd, "q", 1u, "0.5"},
                                                  {folder.write("a.msh", msh_of_steps()), "q", 1u, "1"}}) {
        SCOPED_TRACE(file + " " + field);
        Listener told;
        const std::string expected = fmt::format(fmt::runtime(note), field, step, time);
        const auto is_told = [&] { return std::ranges::count(std::exchange(told.noted, {}), expected); };
        InfoJob info;
        info.grid.file = file;
        info.field.name = field;
        info.chart = 2;
        const auto found = look_into(info, told);
        ASSERT_TRUE(found) << found.error().message;
        EXPECT_EQ(found->step, step);
        EXPECT_EQ(found->chart->field, field);
        EXPECT_EQ(is_told(), 1);
        ExtractJob extract = job_of(file, "T");
        extract.with = Names{field};
        const auto extracted = extract_files(extract, told);
        ASSERT_TRUE(extracted) << extracted.error().message;
        EXPECT_EQ(is_told(), 1);
        SliceJob slice;
        slice.grid.file = file;
        slice.shape = Plane{{1, 0, 0}, 0.3};
        slice.with = Names{"T," + std::string(field)};
        const auto sliced = slice_files(slice, told);
        ASSERT_TRUE(sliced) << sliced.error().message;
        EXPECT_EQ(fmt::format("{}", sliced->surfaces.at(0).time.value()), time);
        DrawJob draw;
        draw.grid.file = file;
        draw.color_by = field;
        draw.out = folder.file("p.png");
        draw.picture.width = draw.picture.height = 16;
        told.noted.clear();
        const auto drawn = draw_files(draw, told);
        ASSERT_TRUE(drawn) << drawn.error().message;
        EXPECT_EQ(drawn->input.step, step);
        EXPECT_EQ(is_told(), 1);
        PackJob pack;
        pack.grid.file = file;
        pack.fields = {field};
        pack.out = folder.file("p.isotet");
        const auto packed = pack_file(pack, told);
        ASSERT_TRUE(packed) << packed.error().message;
        EXPECT_EQ(is_told(), 1);
        BenchJob measure;
        measure.grid.file = file;
        measure.field.name = field;
        measure.rounds = 1;
        measure.device.name = "none";
        const auto measured = measure_methods(measure, told);
        ASSERT_TRUE(measured) << measured.error().message;
        EXPECT_EQ(is_told(), 1);
    }
}

TEST_F(SeriesFields, OfALongSeriesAreFoundWhereTheyBegin) {
    std::string list;
    folder.write("without.vtu", vtu({"T"}, 1));
    folder.write("with.vtu", vtu({"T", "q"}, 1));
    constexpr int steps = 200, first = 137;
    for (int step = 0; step < steps; ++step)
        list += fmt::format("<DataSet timestep='{}' file='{}.vtu'/>", step, step < first ? "without" : "with");
    const std::string file =
        folder.write("long.pvd", "<VTKFile type='Collection'><Collection>" + list + "</Collection></VTKFile>");
    const auto numbers = extract_files(job_of(file, "q"), listener);
    ASSERT_TRUE(numbers) << numbers.error().message;
    EXPECT_EQ(numbers->surfaces.at(0).time, first);
    EXPECT_EQ(extract_files(job_of(file, "p"), listener).error().message,
              "there is no field 'p': the grid has 'T', 'q'");
}

TEST_F(SeriesFields, ThatNoStepHasTogetherAreAnError) {
    folder.write("c.vtu", vtu({"r"}, 1));
    ExtractJob job = job_of(pvd, "q");
    job.with = Names{"r"};
    EXPECT_EQ(extract_files(job, listener).error().message, "no time step has all of these fields: 'q', 'r'");
}

/// As info, extract and render: the first step where something varies, and what that has.
TEST_F(SeriesFields, ArePackedAsTheStepThatIsTakenHasThem) {
    PackJob job;
    job.grid.file = folder.write("a.msh", msh_of_steps());
    job.out = folder.file("p.isotet");
    const auto packed = pack_file(job, listener);
    ASSERT_TRUE(packed) << packed.error().message;
    ASSERT_EQ(packed->fields.size(), 2u);
    EXPECT_EQ(packed->fields[0].upper, 3);
    EXPECT_EQ(std::ranges::count(listener.noted,
                                 "the file has 3 time steps, and no field varies at step 0: step 1, time 1, was taken; "
                                 "`time` and `step` choose another"),
              1);
    job.grid.step = 0;
    EXPECT_EQ(pack_file(job, listener).value().fields.size(), 1u) << "q is not there";
}

TEST_F(SeriesFields, StepsWithoutTheFieldAreSkippedWithOneNote) {
    for (const auto& [field, steps, note] :
         {std::tuple{"q", 2u, "'q' is not in 1 of the 3 time steps, which is skipped: 0"},
          {"r", 1u, "'r' is not in 2 of the 3 time steps, which are skipped: 0, 1"},
          {"T", 3u, ""}}) {
        for (const std::string& file : files()) {
            Listener told;
            ExtractJob job = job_of(file, field);
            job.all_steps = true;
            job.out = folder.file("o_{step}.vtp");
            const auto numbers = extract_files(job, told);
            ASSERT_TRUE(numbers) << numbers.error().message;
            EXPECT_EQ(numbers->surfaces.size(), steps);
            EXPECT_EQ(std::filesystem::exists(folder.file("o_0.vtp")), steps == 3u);
            for (const char* name : {"o_0.vtp", "o_1.vtp", "o_2.vtp"}) std::filesystem::remove(folder.file(name));
            Names noted;
            for (const std::string& sentence : told.noted)
                if (sentence.find("skipped") != std::string::npos) noted.push_back(sentence);
            EXPECT_EQ(noted, *note ? Names{note} : Names{});
        }
    }
}

TEST_F(SeriesFields, ThatCellsAreChosenByMayBeginLater) {
    const auto with_cells = [](int cells) {
        std::string text = vtu({"T"}, cells);
        const std::string field = fmt::format(
            "<CellData><DataArray type=\"Int32\" Name=\"mat\">1 {}</DataArray></CellData>", cells == 2 ? "2" : "");
        return text.insert(text.find("<Points>"), field);
    };
    folder.write("b.vtu", with_cells(2));
    folder.write("c.vtu", with_cells(1));
    for (const std::string& file : files()) {
        Listener told;
        ExtractJob job = job_of(file, "T");
        job.grid.cells = {"mat=1"};
        const auto numbers = extract_files(job, told);
        ASSERT_TRUE(numbers) << numbers.error().message;
        EXPECT_EQ(numbers->surfaces.at(0).triangles, 2u);
        EXPECT_EQ(std::ranges::count(told.noted,
                                     "the file has 3 time steps, what is chosen is not in those before: step 1, "
                                     "time 0.5, was taken; `time` and `step` choose another"),
                  1)
            << testing::PrintToString(told.noted);
        job.all_steps = true;
        job.out = folder.file("o_{step}.vtp");
        const auto all = extract_files(job, told);
        ASSERT_TRUE(all) << all.error().message;
        EXPECT_EQ(all->surfaces.size(), 2u);
        EXPECT_EQ(
            std::ranges::count(told.noted, "1 of the 3 time steps does not have the cells mat=1 and is skipped: 0"), 1)
            << testing::PrintToString(told.noted);
        job.grid.cells = {"m=1"};
        EXPECT_EQ(extract_files(job, told).error().message,
                  "`cells` got 'm=1', but there is no cell field 'm': the grid has 'mat'");
    }
}

TEST_F(SeriesFields, OfNoStepAreAnErrorWithThoseOfAll) {
    ExtractJob job = job_of(pvd, "s");
    job.all_steps = true;
    job.out = folder.file("o_{step}.vtp");
    EXPECT_EQ(extract_files(job, listener).error().message, "there is no field 's': the grid has 'T', 'q', 'r'");
}

TEST_F(SeriesFields, ToCarryMayBeOfSomeStepsOnly) {
    ExtractJob job = job_of(pvd, "T");
    job.all_steps = true;
    job.out = folder.file("o_{step}.vtp");
    job.with = Names{"r"};
    const auto numbers = extract_files(job, listener);
    ASSERT_TRUE(numbers) << numbers.error().message;
    EXPECT_EQ(numbers->surfaces.size(), 3u);
    ASSERT_FALSE(listener.noted.empty());
    EXPECT_EQ(listener.noted.back(), "not every time step has 'r': the surfaces of the others lack it");
}

TEST_F(SeriesFields, OfAStepCountWhereNoneIsNamed) {
    ExtractJob job = job_of(pvd, "");
    job.grid.step = 0;
    EXPECT_EQ(extract_files(job, listener)->field.name, "T");
    job.grid.step = 1;
    EXPECT_EQ(extract_files(job, listener)->field.name, "T") << "not the first one there, q";
}

TEST_F(SeriesFields, BeginAfterAStepWithoutAny) {
    folder.write("none.vtu", vtu({}, 1));
    const std::string late = folder.write("late.pvd", "<VTKFile type='Collection'><Collection>"
                                                      "<DataSet timestep='0' file='none.vtu'/>"
                                                      "<DataSet timestep='1' file='a.vtu'/></Collection></VTKFile>");
    ExtractJob job = job_of(late, "");
    const auto extracted = extract_files(job, listener);
    ASSERT_TRUE(extracted) << extracted.error().message;
    EXPECT_EQ(extracted->field.name, "T");
    EXPECT_EQ(extracted->surfaces.size(), 1u);
    EXPECT_EQ(extracted->surfaces[0].time, 1.0);
    job.all_steps = true;
    job.out = folder.file("o_{step}.vtp");
    const auto all = extract_files(job, listener);
    ASSERT_TRUE(all) << all.error().message;
    EXPECT_FALSE(std::filesystem::exists(folder.file("o_0.vtp")));
    EXPECT_TRUE(std::filesystem::exists(folder.file("o_1.vtp")));
    DrawJob draw;
    draw.grid.file = late;
    draw.picture.width = draw.picture.height = 16;
    draw.plain = true;
    draw.all_steps = true;
    draw.out = folder.file("p-{frame}.png");
    const auto drawn = draw_files(draw, listener);
    ASSERT_TRUE(drawn) << drawn.error().message;
    EXPECT_EQ(drawn->pictures.pictures, 1u);
}

TEST_F(SeriesFields, OfLaterStepsAreTakenWhereTheOnlyOneOfTheFirstDoesNotVary) {
    std::string constant = vtu({"T"}, 1), varying = vtu({"T", "k"}, 1);
    for (std::string* text : {&constant, &varying}) text->replace(text->find(">0 1 2 3<"), 9, ">3 3 3 3<");
    folder.write("constant.vtu", constant);
    folder.write("varying.vtu", varying);
    const std::string late = folder.write("k.pvd", "<VTKFile type='Collection'><Collection>"
                                                   "<DataSet timestep='0' file='constant.vtu'/>"
                                                   "<DataSet timestep='1' file='varying.vtu'/></Collection></VTKFile>");
    const auto extracted = extract_files(job_of(late, ""), listener);
    ASSERT_TRUE(extracted) << extracted.error().message;
    EXPECT_EQ(extracted->field.name, "k");
}

TEST_F(SeriesFields, PicturesOfStepsWithoutTheFieldAreSkipped) {
    DrawJob job;
    job.grid.file = pvd;
    job.field.name = "q";
    job.isovalues = {1.5};
    job.all_steps = true;
    job.out = folder.file("p-{frame}.png");
    job.picture.width = job.picture.height = 16;
    job.plain = true;
    const auto drawn = draw_files(job, listener);
    ASSERT_TRUE(drawn) << drawn.error().message;
    EXPECT_EQ(drawn->pictures.pictures, 2u);
    EXPECT_NE(std::ranges::find(listener.noted, "'q' is not in 1 of the 3 time steps, which is skipped: 0"),
              listener.noted.end());
}

TEST_F(SeriesFields, PicturesAndPackedFilesLeaveOutBrokenSteps) {
    std::filesystem::remove(folder.file("b.vtu"));
    for (const std::string& file : files()) {
        SCOPED_TRACE(file);
        DrawJob draw;
        draw.grid.file = file;
        draw.field.name = "T";
        draw.isovalues = {1.5};
        draw.all_steps = true;
        draw.out = folder.file("p-{frame}.png");
        draw.picture.width = draw.picture.height = 16;
        draw.plain = true;
        Listener told;
        const auto drawn = draw_files(draw, told);
        ASSERT_TRUE(drawn) << drawn.error().message;
        EXPECT_EQ(drawn->pictures.pictures, 2u);
        EXPECT_TRUE(std::ranges::any_of(told.noted, [](const std::string& note) {
            return note.starts_with("step 1 cannot be read and is left out: ");
        }));
        PackJob pack;
        pack.grid.file = file;
        pack.all_steps = true;
        pack.out = folder.file("s.isotet");
        const auto packed = pack_file(pack, told);
        ASSERT_TRUE(packed) << packed.error().message;
        EXPECT_EQ(packed->steps, 2u);
    }
}

TEST_F(SeriesFields, ClipsOfStepsWithoutTheFieldAreSkipped) {
    for (const std::string& file : files()) {
        Listener told;
        ClipJob job;
        job.grid.file = file;
        job.field.name = "q + 0";
        job.range = SolidRange::above(1.5);
        job.all_steps = true;
        job.out = folder.file("k_{step}.vtu");
        const auto clipped = clip_files(job, told);
        ASSERT_TRUE(clipped) << clipped.error().message;
        EXPECT_EQ(clipped->steps.size(), 2u);
        EXPECT_EQ(std::ranges::count(told.noted, "'q + 0' is not in 1 of the 3 time steps, which is skipped: 0"), 1);
        job.field.name = "s";
        EXPECT_EQ(clip_files(job, told).error().message, "there is no field 's': the grid has 'T', 'q', 'r'");
    }
}

/// A packed file has the same cells in all steps: those of the first two differ.
TEST_F(SeriesFields, ArePackedWhereAllStepsHaveThemOrWithoutStepsThatLackThose) {
    folder.write("b.vtu", vtu({"q", "T"}, 1));
    for (const auto& [fields, steps, packed, note] :
         {std::tuple{
              Names{}, 3u, 1u,
              "not packed: 'q' (not in step 0: `fields` takes it, without such steps), 'r' (not in step 0: "
              "`fields` takes it, without such steps); `fields` takes components, `cell_fields` fields of cells"},
          {Names{"T", "q"}, 2u, 2u, "'q' is not in 1 of the 3 time steps, which is skipped: 0"}}) {
        Listener told;
        PackJob job;
        job.grid.file = pvd;
        job.fields = fields;
        job.all_steps = true;
        job.out = folder.file("all.isotet");
        const auto numbers = pack_file(job, told);
        ASSERT_TRUE(numbers) << numbers.error().message;
        EXPECT_EQ(numbers->steps, steps);
        EXPECT_EQ(numbers->fields.size(), packed);
        EXPECT_EQ(std::ranges::count(told.noted, note), 1) << testing::PrintToString(told.noted);
        EXPECT_EQ(PackedFile::open(job.out).value().info().steps, steps);
    }
}

TEST_F(SeriesFields, InfoTellsThoseOfTheStep) {
    InfoJob job;
    job.grid.file = series;
    job.grid.step = 1;
    const auto found = look_into(job, listener);
    ASSERT_TRUE(found) << found.error().message;
    EXPECT_EQ(found->fields.size(), 2u);
    EXPECT_EQ(found->file.fields.size(), 2u);
    EXPECT_EQ(found->report.cells, 2u);
}

TEST_F(SeriesFields, ABrokenStepDoesNotEndTheOthers) {
    folder.write("b.vtu", vtu({"T"}, 1).substr(0, 300));
    for (const std::string& file : files()) {
        SCOPED_TRACE(file);
        ExtractJob job = job_of(file, "T");
        job.all_steps = true;
        job.out = folder.file("out_{step}.vtp");
        const ExtractNumbers done = extract_files(job, listener).value();
        ASSERT_EQ(done.broken_steps.size(), 1u);
        EXPECT_EQ(done.broken_steps[0].step, 1u);
        EXPECT_EQ(done.broken_steps[0].error.code, ErrorCode::invalid_data);
        EXPECT_EQ(done.surfaces.size(), 2u);
        EXPECT_EQ(done.surfaces[1].time, 1.0);
        EXPECT_TRUE(std::filesystem::exists(done.collection));
        ClipJob clip;
        clip.grid = job.grid;
        clip.field = job.field;
        clip.all_steps = true;
        clip.range = SolidRange::above(1.5);
        clip.out = folder.file("clip_{step}.vtu");
        const auto clipped = clip_files(clip, listener);
        ASSERT_TRUE(clipped) << clipped.error().message;
        EXPECT_EQ(clipped->broken_steps.size(), 1u);
        EXPECT_EQ(clipped->steps.size(), 2u);
    }
}

TEST_F(SeriesFields, OfAnIndexWhoseFirstFileIsMissing) {
    std::filesystem::remove(folder.file("a.vtu"));
    for (const std::string& file : files()) {
        SCOPED_TRACE(file);
        ExtractJob job = job_of(file, "T");
        Listener told;
        auto extracted = extract_files(job, told);
        ASSERT_TRUE(extracted) << extracted.error().message;
        EXPECT_EQ(extracted->surfaces[0].time, 0.5);
        EXPECT_TRUE(std::ranges::any_of(told.noted, [](const std::string& note) {
            return note.find("step 0 cannot be read (") != std::string::npos &&
                   note.find("step 1, time 0.5, was taken") != std::string::npos;
        }));
        job.grid.time = 1;
        extracted = extract_files(job, told);
        ASSERT_TRUE(extracted) << extracted.error().message;
        EXPECT_EQ(extracted->surfaces[0].time, 1.0);
        InfoJob info;
        info.grid.file = file;
        const auto summary = look_into(info, told);
        ASSERT_TRUE(summary) << summary.error().message;
        EXPECT_EQ(summary->step, 1u);
        info.grid.step = 0;
        EXPECT_FALSE(look_into(info, told));
    }
    for (const char* name : {"b.vtu", "c.vtu"}) std::filesystem::remove(folder.file(name));
    const auto none = extract_files(job_of(pvd, "T"), listener);
    ASSERT_FALSE(none);
    EXPECT_NE(none.error().message.find("a.vtu"), std::string::npos) << none.error().message;
}

TEST_F(SeriesFields, OfAFewStepsOfManyAreFound) {
    std::string sets;
    for (int step = 0; step < 80; ++step)
        sets += fmt::format("<DataSet timestep='{}' file='{}.vtu'/>", step, step == 42 ? "c" : "a");
    const std::string many =
        folder.write("many.pvd", "<VTKFile type='Collection'><Collection>" + sets + "</Collection></VTKFile>");
    const auto extracted = extract_files(job_of(many, "r"), listener);
    ASSERT_TRUE(extracted) << extracted.error().message;
    EXPECT_EQ(extracted->surfaces[0].time, 42.0);
    EXPECT_FALSE(extract_files(job_of(many, "s"), listener));
}

TEST_F(SeriesFields, AFirstStepThatCannotBeReadIsPassedOver) {
    std::string broken = vtu({"T", "q", "r"}, 1);
    broken.replace(broken.find(">0 1 2 3<"), 9, ">0 1<");
    folder.write("a.vtu", broken);
    ExtractJob job = job_of(pvd, "T");
    const auto extracted = extract_files(job, listener);
    ASSERT_TRUE(extracted) << extracted.error().message;
    EXPECT_EQ(extracted->surfaces[0].time, 0.5);
    EXPECT_TRUE(std::ranges::any_of(
        listener.noted, [](const std::string& note) { return note.starts_with("step 0 cannot be taken: "); }));
    job.grid.step = 0;
    EXPECT_FALSE(extract_files(job, listener));
}

TEST_F(SeriesFields, OfBrokenStepsAloneAreAnError) {
    for (const char* name : {"a.vtu", "b.vtu", "c.vtu"}) folder.write(name, vtu({"T"}, 1).substr(0, 300));
    ExtractJob job = job_of(pvd, "T");
    job.all_steps = true;
    job.out = folder.file("out_{step}.vtp");
    EXPECT_FALSE(extract_files(job, listener));
}

/// Of two data sets of the series above, side by side: b, of steps 1 and 2.
TEST_F(SeriesFields, StepsWithoutTheChosenBlockAreSkipped) {
    const auto index = [](const std::string& more) {
        return "<VTKFile type='vtkMultiBlockDataSet'><vtkMultiBlockDataSet><DataSet name='a' file='a.vtu'/>" + more +
               "</vtkMultiBlockDataSet></VTKFile>";
    };
    folder.write("0.vtm", index(""));
    for (const char* name : {"1.vtm", "2.vtm"}) folder.write(name, index("<DataSet name='b' file='b.vtu'/>"));
    const std::string grid = folder.write("b.pvd", "<VTKFile type='Collection'><Collection>"
                                                   "<DataSet timestep='0' file='0.vtm'/><DataSet timestep='1' "
                                                   "file='1.vtm'/><DataSet timestep='2' file='2.vtm'/>"
                                                   "</Collection></VTKFile>");
    ExtractJob job = job_of(grid, "T");
    job.grid.blocks = {"b"};
    const auto one = extract_files(job, listener);
    ASSERT_TRUE(one) << one.error().message;
    EXPECT_EQ(one->surfaces.at(0).time, 1.0);
    job.all_steps = true;
    job.out = folder.file("o_{step}.vtp");
    const auto all = extract_files(job, listener);
    ASSERT_TRUE(all) << all.error().message;
    EXPECT_EQ(all->surfaces.size(), 2u);
    EXPECT_FALSE(std::filesystem::exists(folder.file("o_0.vtp")));
    EXPECT_EQ(
        std::ranges::count(listener.noted, "1 of the 3 time steps does not have the blocks 'b' and is skipped: 0"), 1);
    InfoJob info;
    info.grid = job.grid;
    info.all_steps = true;
    const auto summary = look_into(info, listener);
    ASSERT_TRUE(summary) << summary.error().message;
    EXPECT_EQ(summary->step, 1u);
    EXPECT_EQ(summary->steps, 2u);
    info.heads = true;
    EXPECT_EQ(look_into(info, listener).value().step, 1u);
    PackJob pack;
    pack.grid = job.grid;
    pack.out = folder.file("o.isotet");
    const auto packed = pack_file(pack, listener);
    EXPECT_TRUE(packed) << packed.error().message;
    info.grid.blocks = {"c"};
    const auto none = look_into(info, listener);
    ASSERT_FALSE(none);
    EXPECT_EQ(none.error().message, "block 'c' is not in the file, which has 1 'a'");
    info.grid.blocks = {"b"};
    info.grid.step = 0;
    EXPECT_FALSE(look_into(info, listener));
}

} // namespace
} // namespace isotet::jobs
