// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/jobs/extract_files.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <isotet/make.hpp>
#include <isotet/read.hpp>
#include <isotet/write.hpp>

#include "jobs/listener.hpp"
#include "support/temporary_folder.hpp"

namespace isotet::jobs {
namespace {

using test::Listener;

ExtractJob job_of(const std::string& grid, const std::string& out) {
    ExtractJob job;
    job.grid.file = grid;
    job.out = out;
    return job;
}

TEST(ExtractFiles, WritesASurfaceAndTellsItsNumbers) {
    const test::TemporaryFolder folder;
    Listener listener;
    ExtractJob job = job_of("make:kuhn:8:sphere", folder.file("out.vtp"));
    job.isovalues = {0.5};
    const ExtractNumbers numbers = extract_files(job, listener).value();
    EXPECT_TRUE(listener.noted.empty());
    ASSERT_EQ(numbers.surfaces.size(), 1u);
    EXPECT_EQ(numbers.cells, 6u * 8 * 8 * 8);
    EXPECT_EQ(numbers.method, Method::direct);
    EXPECT_EQ(numbers.why, "1 surface");
    const SurfaceFile read = read_surface(folder.file("out.vtp")).value();
    EXPECT_EQ(read.surface.triangle_count(), numbers.surfaces[0].triangles);
    EXPECT_GT(numbers.surfaces[0].triangles, 0u);
    EXPECT_EQ(numbers.surfaces[0].file, folder.file("out.vtp"));
}

/// The first nine of 729 points have a number in place of no value, the others 0 to 1.73205.
std::string with_fill_values(const test::TemporaryFolder& folder, float fill, const char* name = "grid.vtu") {
    Grid grid = make_grid({.shape = "kuhn", .side = 8, .fields = {"sphere"}}).value();
    const auto values = grid.point_fields[0].values.as<float>();
    std::vector<float> filled(values.begin(), values.end());
    std::fill_n(filled.begin(), 9, fill);
    grid.point_fields[0].values = Array::own(std::move(filled));
    EXPECT_TRUE(write_grid(grid, folder.file(name)));
    return folder.file(name);
}

TEST(ExtractFiles, ChoosesIsovaluesWithoutNumbersThatStandForNone) {
    const test::TemporaryFolder folder;
    for (const auto& [fill, text, expression] : {std::tuple{1e20F, "1e+20", "if(sphere < 5e+19, sphere, 0/0)"},
                                                 {-9999.0F, "-9999", "if(sphere > -5e+03, sphere, 0/0)"}})
        for (const auto method : {Method::direct, Method::clusters}) {
            SCOPED_TRACE(fmt::format("{} {}", text, method == Method::direct));
            Listener listener;
            ExtractJob job = job_of(with_fill_values(folder, fill), folder.file("out.vtp"));
            job.contour.method = method;
            const ExtractNumbers numbers = extract_files(job, listener).value();
            ASSERT_EQ(numbers.surfaces.size(), 1u);
            EXPECT_NEAR(numbers.surfaces[0].isovalue, std::sqrt(3) / 2, 1e-6);
            ASSERT_EQ(listener.noted.size(), 2u);
            EXPECT_EQ(
                listener.noted[0],
                fmt::format("of the 729 points of 'sphere' 9 have {}, far from all others (0 to 1.73205), as "
                            "where there is no value: isovalues are chosen without it; `field` '{}' leaves out the "
                            "cells there, too",
                            text, expression));
            EXPECT_NE(listener.noted[1].find("the middle of the range 0 to 1.73205"), std::string::npos);
            job.field.name = expression;
            job.levels = 3;
            for (const SurfaceNumbers& surface : extract_files(job, listener).value().surfaces)
                EXPECT_LT(surface.isovalue, 2);
            job.field.name.clear();
            job.levels = 0;
            job.isovalues = {fill / 2.0};
            const ExtractNumbers asked = extract_files(job, listener).value();
            EXPECT_EQ(asked.surfaces.at(0).isovalue, fill / 2.0) << "what is given counts";
            EXPECT_GT(asked.surfaces.at(0).triangles, 0u);
            const auto is_fill_note = [](const std::string& note) { return note.starts_with("of the 729 points"); };
            EXPECT_EQ(std::ranges::count_if(listener.noted, is_fill_note), 1) << "there is none in the expression";
        }
}

/// Cells of 1 to 2, but one in 40, which is dry.
std::string with_dry_cells(const test::TemporaryFolder& folder, const char* name) {
    Grid grid = make_grid({.shape = "kuhn", .side = 8, .fields = {}}).value();
    std::vector<double> head(grid.cells.count());
    for (std::size_t i = 0; i < head.size(); ++i)
        head[i] = i % 40 == 0 ? 1e30 : 1 + static_cast<double>(i) / static_cast<double>(head.size() - 1);
    grid.point_fields.clear();
    grid.cell_fields = {{"head", Array::own(std::move(head))}};
    EXPECT_TRUE(write_grid(grid, folder.file(name)));
    return folder.file(name);
}

TEST(ExtractFiles, ChoosesIsovaluesBetweenCellsThatHaveAValue) {
    const test::TemporaryFolder folder;
    for (const char* name : {"grid.vtu", "grid.vtk"})
        for (const bool is_expression : {false, true})
            for (const auto method : {Method::direct, Method::clusters}) {
                SCOPED_TRACE(fmt::format("{} {} {}", name, is_expression, method == Method::direct));
                ExtractJob job = job_of(with_dry_cells(folder, name), folder.file("out.vtp"));
                job.contour.method = method;
                if (is_expression) job.field.name = "head*1";
                Listener listener;
                const ExtractNumbers numbers = extract_files(job, listener).value();
                EXPECT_TRUE(numbers.averaged);
                EXPECT_NEAR(numbers.surfaces.at(0).isovalue, 1.5, 1e-3);
                const auto is_fill_note = [](const std::string& note) {
                    return note.starts_with("of the 3,072 cells of 'head") && note.find("77 have 1e+30") < note.size();
                };
                EXPECT_EQ(std::ranges::count_if(listener.noted, is_fill_note), 1);
                if (is_expression) continue;
                job.field.name = "if(head < 1e29, head, 0/0)";
                job.levels = 5;
                Listener without;
                for (const SurfaceNumbers& surface : extract_files(job, without).value().surfaces)
                    EXPECT_GT(surface.triangles, 0u);
                EXPECT_EQ(std::ranges::count_if(without.noted, is_fill_note), 0);
            }
}

TEST(ExtractFiles, WritesAFileForEachIsovalue) {
    const test::TemporaryFolder folder;
    Listener listener;
    ExtractJob job = job_of("make:kuhn:4:sphere", folder.file("s-{value}.ply"));
    job.isovalues = {0.5, 0.25, 0.5, 7};
    const ExtractNumbers numbers = extract_files(job, listener).value();
    ASSERT_EQ(numbers.surfaces.size(), 3u);
    for (const char* name : {"s-0.5.ply", "s-0.25.ply", "s-7.ply"})
        EXPECT_TRUE(std::filesystem::exists(folder.file(name))) << name;
    ASSERT_EQ(listener.noted.size(), 2u);
    EXPECT_EQ(listener.noted[0], "the isovalue 0.5 was given more than once: it is extracted once");
    EXPECT_EQ(listener.noted[1], "isovalue 7 is outside the range of 'sphere', 0 to 1.73205: the surface is empty");
    job.isovalues = {1.7320509};
    job.allow_empty = true;
    EXPECT_TRUE(extract_files(job, listener));
    EXPECT_EQ(listener.noted.back(),
              "isovalue 1.7320509 is outside the range of 'sphere', 0 to 1.7320508: the surface is empty");
}

TEST(ExtractFiles, ContoursAndCarriesExpressions) {
    const test::TemporaryFolder folder;
    Listener listener;
    ExtractJob job = job_of("make:mixed:6:sphere,gyroid", folder.file("named.vtp"));
    job.field.name = "sphere";
    job.isovalues = {0.5};
    job.with = {{"gyroid"}};
    ASSERT_TRUE(extract_files(job, listener));
    job.out = folder.file("computed.vtp");
    job.field.name = "2*sphere - sphere"; // exactly
    job.with = {{"gyroid + 0*sphere,max(gyroid, sphere)"}};
    ASSERT_TRUE(extract_files(job, listener));
    const Surface named = read_surface(folder.file("named.vtp")).value().surface;
    const Surface computed = read_surface(folder.file("computed.vtp")).value().surface;
    ASSERT_EQ(computed.positions.bytes(), named.positions.bytes());
    EXPECT_EQ(std::memcmp(computed.positions.data(), named.positions.data(), named.positions.bytes()), 0);
    ASSERT_EQ(computed.point_fields.size(), 2u);
    EXPECT_EQ(computed.point_fields[0].name, "gyroid + 0*sphere");
    EXPECT_EQ(computed.point_fields[1].name, "max(gyroid, sphere)");
    const Array &values = computed.point_fields[0].values, &same = named.point_fields[0].values;
    EXPECT_EQ(std::memcmp(values.data(), same.data(), same.bytes()), 0);

    job.field.name = "grad(sphere)";
    job.piece = PieceOf{};
    EXPECT_FALSE(extract_files(job, listener));
    job.piece.reset();
    job.field.name = "sphere + q";
    const auto unknown = extract_files(job, listener);
    ASSERT_FALSE(unknown);
    EXPECT_NE(unknown.error().message.find("there is no field 'q': there is '"), std::string::npos)
        << unknown.error().message;
}

/// Of a field T of cells alone; f is one of points.
class CellExpressions : public testing::Test {
protected:
    void SetUp() override {
        Grid grid = make_grid({.shape = "hex", .side = 4, .fields = {"sphere"}}).value();
        std::vector<double> cells(grid.cells.count());
        for (std::size_t i = 0; i < cells.size(); ++i) cells[i] = static_cast<double>(i);
        grid.point_fields[0].name = "f";
        grid.cell_fields = {{"T", Array::own(std::move(cells))}};
        path = folder.file("cells.vtu");
        write_grid(grid, path).value();
    }
    ExtractJob job(const std::string& out) const {
        ExtractJob job = job_of(path, folder.file(out));
        job.field.name = "f";
        job.isovalues = {0.5};
        return job;
    }
    test::TemporaryFolder folder;
    Listener listener;
    std::string path;
};

TEST_F(CellExpressions, AreCarriedAsTheyAreContoured) {
    ExtractJob carrying = job("carried.vtp");
    for (const char* with : {"T*2", "T + f", "mag(grad(T))"}) {
        carrying.with = {{with}};
        const auto done = extract_files(carrying, listener);
        ASSERT_TRUE(done) << done.error().message;
        const Surface surface = read_surface(carrying.out).value().surface;
        ASSERT_EQ(surface.point_fields.size(), 1u);
        EXPECT_EQ(surface.point_fields[0].name, with);
        EXPECT_TRUE(surface.cell_fields.empty());
    }
    carrying.field.name = "T*2";
    carrying.isovalues = {30};
    carrying.with = {{"T*2"}};
    ASSERT_TRUE(extract_files(carrying, listener));
    const Surface surface = read_surface(carrying.out).value().surface;
    ASSERT_GT(surface.vertex_count(), 0u);
    for (std::size_t i = 0; i < surface.vertex_count(); ++i)
        EXPECT_NEAR(surface.point_fields[0].values.at(i), 30, 1e-9);
}

TEST_F(CellExpressions, ColourVertices) {
    ExtractJob coloring = job("colored.vtp"), carrying = job("carried.vtp");
    coloring.colors.by = carrying.colors.by = "T*2 + f";
    coloring.with = {std::vector<std::string>()};
    carrying.with = {{"T*2 + f"}};
    for (const ExtractJob& each : {coloring, carrying}) {
        const auto done = extract_files(each, listener);
        ASSERT_TRUE(done) << done.error().message;
    }
    EXPECT_TRUE(test::content_of(coloring.out) == test::content_of(carrying.out));
    coloring.with.reset(); // all fields
    ASSERT_TRUE(extract_files(coloring, listener));
    std::vector<std::string> names;
    for (const Field& field : read_surface(coloring.out).value().surface.point_fields) names.push_back(field.name);
    EXPECT_EQ(names, (std::vector<std::string>{"f", "T*2 + f", "rgb"}));
    coloring.colors.by = "T*2 + g";
    EXPECT_FALSE(extract_files(coloring, listener));
}

TEST(ExtractFiles, WritesNoFileOfTheCallerAndNoInput) {
    const test::TemporaryFolder folder;
    Listener listener;
    ExtractJob job = job_of("make:kuhn:4:sphere", folder.file("a-{value}.vtp"));
    job.isovalues = {0.5};
    job.other_outputs = {folder.file("a-0.5.vtp")};
    EXPECT_EQ(extract_files(job, listener).error().code, ErrorCode::invalid_argument);
    EXPECT_FALSE(std::filesystem::exists(folder.file("a-0.5.vtp")));
    job.out = job.other_outputs[0];
    EXPECT_EQ(extract_files(job, listener).error().code, ErrorCode::invalid_argument);
}

TEST(ExtractFiles, GivesCentresOfPolyhedraTheValuesOfTheirCells) {
    const test::TemporaryFolder folder;
    Grid grid = make_grid({.shape = "kelvin", .side = 4, .fields = {"sphere"}}).value();
    std::vector<float> numbers(grid.cells.count());
    for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<float>(i * 31 % 17);
    grid.cell_fields = {{"number", Array::own(std::move(numbers))}};
    ASSERT_TRUE(write_grid(grid, folder.file("grid.vtu")));
    ExtractJob job = job_of(folder.file("grid.vtu"), folder.file("mean.vtp"));
    job.field.name = "number";
    job.isovalues = {8.5};
    Listener listener;
    const std::uint64_t mean = extract_files(job, listener).value().surfaces[0].triangles;
    job.field.own_centres = true;
    job.out = folder.file("own.vtp");
    const std::uint64_t own = extract_files(job, listener).value().surfaces[0].triangles;
    EXPECT_GT(own, mean); // a bubble around each cell that stands out

    job.field.name = "sphere";
    EXPECT_EQ(extract_files(job, listener).error().message,
              "`centre` own takes a cell field, but 'sphere' is one of points");
    job.field.name = "number";
    job.piece = PieceOf{0, 2};
    EXPECT_EQ(extract_files(job, listener).error().message, "`piece` takes `centre` mean only");
}

TEST(ExtractFiles, AnEmptySurfaceIsAnErrorWhereAsked) {
    const test::TemporaryFolder folder;
    Listener listener;
    ExtractJob job = job_of("make:kuhn:4:sphere", folder.file("a.vtp"));
    job.isovalues = {7};
    job.fail_if_empty = true;
    const auto failed = extract_files(job, listener);
    ASSERT_FALSE(failed);
    EXPECT_TRUE(failed.error().message.starts_with("`fail_if_empty`: isovalue 7 is outside")) << failed.error().message;
    EXPECT_FALSE(std::filesystem::exists(folder.file("a.vtp")));
}

TEST(ExtractFiles, TakesIsovaluesByTheirShareAndTellsVolumes) {
    const test::TemporaryFolder folder;
    const Grid grid = make_grid({.shape = "kuhn", .side = 8, .fields = {"gyroid"}}).value();
    ASSERT_TRUE(write_grid(grid, folder.file("g.vtu")));
    Listener listener;
    ExtractJob job = job_of(folder.file("g.vtu"), "");
    job.isovalues = {0.25};
    job.shares = {{IsovalueShare::Of::volume, 90}, {IsovalueShare::Of::points, 100}};
    job.volumes = true;
    const ExtractNumbers numbers = extract_files(job, listener).value();
    ASSERT_EQ(numbers.surfaces.size(), 3u);
    EXPECT_EQ(numbers.surfaces[0].isovalue, 0.25);
    EXPECT_NEAR(numbers.surfaces[1].volumes->below, 7.2, 1e-6);
    EXPECT_NEAR(numbers.surfaces[1].volumes->above, 0.8, 1e-6);
    EXPECT_EQ(numbers.surfaces[2].isovalue, numbers.field.upper);
    for (const SurfaceNumbers& surface : numbers.surfaces)
        EXPECT_NEAR(surface.volumes->below + surface.volumes->above, 8, 1e-6);
    EXPECT_LT(numbers.surfaces[0].volumes->below, numbers.surfaces[1].volumes->below);

    job.piece = PieceOf{0, 3}; // the share is that of the whole
    job.isovalues.clear();
    const ExtractNumbers piece = extract_files(job, listener).value();
    EXPECT_EQ(piece.surfaces[0].isovalue, numbers.surfaces[1].isovalue);
    EXPECT_NEAR(piece.surfaces[0].volumes->below + piece.surfaces[0].volumes->above, 8.0 / 3, 0.1);
}

TEST(ExtractFiles, StopsWhenTold) {
    const test::TemporaryFolder folder;
    Listener listener;
    listener.stop = true;
    ExtractJob job = job_of("make:kuhn:4:sphere", folder.file("a.vtp"));
    EXPECT_EQ(extract_files(job, listener).error().code, ErrorCode::cancelled);
    EXPECT_FALSE(std::filesystem::exists(folder.file("a.vtp")));
}

TEST(ExtractFiles, RefusesOptionsThatContradictEachOther) {
    Listener listener;
    ExtractJob job = job_of("make:kuhn:4:sphere", "");
    job.engine = EngineChoice::vulkan;
    job.device.name = "none";
    EXPECT_EQ(extract_files(job, listener).error().message, "`engine` vulkan needs a device, but `device` is none");
    job = job_of("make:kuhn:4:sphere", "a.stl");
    job.contour.edge_ends = true;
    EXPECT_EQ(extract_files(job, listener).error().message,
              "`edge_ends` was asked for, but stl holds no such array: .vtp and .vtk do");
}

} // namespace
} // namespace isotet::jobs
