// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// write_surface(), read back by isotet's own readers.
#include <atomic>
#include <cmath>
#include <cstring>

#include <isotet/fields.hpp>
#include <isotet/read.hpp>
#include <isotet/write.hpp>

#include "files/sample_files.hpp"

namespace isotet::test {
namespace {

const std::vector<std::string> all_formats{"vtp", "ply", "stl", "obj", "vtk", "ts", "3mf"};

Surface written_and_read(const Surface& surface, const std::string& format) {
    const Folder folder;
    const auto report = write(surface, folder / ("out." + format));
    EXPECT_EQ(report.bytes, std::filesystem::file_size(folder / ("out." + format)));
    EXPECT_EQ(folder.entries(), 1U);
    auto file = read_surface(folder / ("out." + format));
    EXPECT_TRUE(file) << file.error().message;
    if (!file) return {};
    EXPECT_EQ(file->format, format);
    return std::move(file->surface);
}

Surface with_normals(Surface surface, Normals kind) {
    surface.normals_kind = kind;
    std::vector<float> normals(3 * (kind == Normals::face ? surface.triangle_count() : surface.vertex_count()));
    for (std::size_t i = 0; i < normals.size(); ++i) normals[i] = static_cast<float>(i) / 7;
    surface.normals = Array::own(std::move(normals), 3);
    return surface;
}

class ExactFormat : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Formats, ExactFormat, testing::Values("vtp", "ply", "vtk"));

TEST_P(ExactFormat, GivesBackTheSameBits) {
    const Surface surface = bare_surface(), back = written_and_read(surface, GetParam());
    expect_same(back.positions, surface.positions, "positions");
    expect_same(back.triangles, surface.triangles, "triangles");
    EXPECT_TRUE(back.point_fields.empty());
    EXPECT_TRUE(back.cell_fields.empty());
}

TEST(WriteSurface, KeepsArraysOfTheFileAsAWholeInVtksFormats) {
    const Folder folder;
    for (const char* name : {"out.vtp", "out.vtk", "out.ply"}) {
        WriteOptions options;
        options.field_data = {{"isotet:x", Array::own(std::vector<double>{1, 2, 0.3})},
                              {"of others", Array::own(std::vector<double>{4})}};
        ASSERT_TRUE(write_surface(bare_surface(), folder / name, options));
        const SurfaceFile back = read_surface(folder / name).value();
        expect_same(back.surface.triangles, bare_surface().triangles, name);
        ASSERT_EQ(back.field_data.size(), std::string_view(name) == "out.ply" ? 0u : 1u) << name;
        if (back.field_data.empty()) continue;
        EXPECT_EQ(back.field_data[0].name, "isotet:x");
        expect_same(back.field_data[0].values, options.field_data[0].values, name);
    }
}

TEST_P(ExactFormat, GivesBackNormalsOfVerticesAndFaces) {
    for (const auto kind : {Normals::gradient, Normals::face}) {
        const Surface surface = with_normals(bare_surface(), kind), back = written_and_read(surface, GetParam());
        EXPECT_EQ(back.normals_kind, kind);
        expect_same(back.normals, surface.normals, "normals");
        EXPECT_TRUE(back.point_fields.empty());
        EXPECT_TRUE(back.cell_fields.empty());
    }
}

TEST_P(ExactFormat, GivesBackTheSameDoubles) {
    const Surface surface = moved(bare_surface(), {4200000.125, -0.1, 1e-9});
    expect_same(written_and_read(surface, GetParam()).positions, surface.positions, "positions");
}

TEST_P(ExactFormat, HoldsDoublePositions) {
    Surface surface = bare_surface();
    surface.positions = Array::own(std::vector<double>{0.1, 1e300, -1e-300, 1, 2, 3, 4, 5, 6, 7, 8, 9, 1, 1, 1}, 3);
    expect_same(written_and_read(surface, GetParam()).positions, surface.positions, "positions");
}

TEST_P(ExactFormat, TakesTrianglesOfAnyIndexType) {
    Surface surface = bare_surface();
    surface.triangles = Array::own(std::vector<std::uint64_t>{0, 1, 2, 0, 2, 3, 1, 4, 2}, 3);
    expect_same(written_and_read(surface, GetParam()).triangles, bare_surface().triangles, "triangles");
}

class FieldFormat : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Formats, FieldFormat, testing::Values("vtp", "vtk"));

TEST_P(FieldFormat, GivesBackFieldsEdgeEndsAndSourceCells) {
    const Surface surface = rich_surface(), back = written_and_read(surface, GetParam());
    expect_same(back.edge_ends, surface.edge_ends, "edge ends");
    expect_same(back.edge_weights, surface.edge_weights, "edge weights");
    expect_same(back.source_cells, surface.source_cells, "source cells");
    ASSERT_EQ(back.point_fields.size(), 4U);
    ASSERT_EQ(back.cell_fields.size(), 2U);
    for (const auto* name : {"pressure", "gmsh:velocity"}) {
        ASSERT_TRUE(find_field(back.point_fields, name)) << name;
        expect_same(find_field(back.point_fields, name)->values, find_field(surface.point_fields, name)->values, name);
    }
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(back.cell_fields[i].name, surface.cell_fields[i].name);
        expect_same(back.cell_fields[i].values, surface.cell_fields[i].values, surface.cell_fields[i].name);
    }
}

TEST_P(FieldFormat, AppliesOffsetAndScaleInDouble) {
    const Surface back = written_and_read(rich_surface(), GetParam());
    const auto* field = find_field(back.point_fields, "temperature (K) [mean]");
    ASSERT_TRUE(field);
    ASSERT_EQ(field->values.type(), ScalarType::float64);
    const auto values = field->values.as<double>();
    EXPECT_EQ(values[0], 298.125);
    EXPECT_EQ(values[1], 300.125);
    EXPECT_EQ(values[3], 304.125);
    EXPECT_TRUE(std::isnan(values[4]));
}

TEST(WriteVtp, EscapesNamesThatXmlCannotHold) {
    const Surface back = written_and_read(rich_surface(), "vtp");
    EXPECT_TRUE(find_field(back.point_fields, "caf%E9 %01<&\"'>"));
}

TEST(WriteLegacyVtk, KeepsEveryByteOfAName) {
    const Surface back = written_and_read(rich_surface(), "vtk");
    EXPECT_TRUE(find_field(back.point_fields, "caf\xE9 \x01<&\"'>"));
}

TEST(WritePly, MakesEveryScalarFieldAProperty) {
    const Folder folder;
    const auto report = write(rich_surface(), folder / "out.ply");
    EXPECT_TRUE(has_note(report, "temperature_(K)_[mean]"));
    EXPECT_TRUE(has_note(report, "beyond 2^53"));
    EXPECT_TRUE(has_note(report, "\"edge_ends\", \"edge_weights\""));
    const auto back = read_surface(folder / "out.ply");
    ASSERT_TRUE(back) << back.error().message;
    const auto& fields = back->surface.point_fields;
    ASSERT_TRUE(find_field(fields, "pressure"));
    expect_same(find_field(fields, "pressure")->values, rich_surface().point_fields[0].values, "pressure");
    ASSERT_TRUE(find_field(fields, "temperature_(K)_[mean]"));
    ASSERT_TRUE(find_field(fields, "gmsh:velocity_2"));
    EXPECT_EQ(doubles_of(find_field(fields, "gmsh:velocity_2")->values), (std::vector<double>{3, 6, 9, 0.3, 0}));
    EXPECT_TRUE(find_field(fields, "caf___<&\"'>"));
    EXPECT_EQ(doubles_of(find_field(back->surface.cell_fields, "region")->values), (std::vector<double>{1, 2, 255}));
    EXPECT_EQ(find_field(back->surface.cell_fields, "big")->values.type(), ScalarType::float64);
}

TEST(WritePly, GivesFieldsThatWouldHaveOneNameTwoNames) {
    Surface surface = bare_surface();
    const Array values = Array::own(std::vector<float>{1, 2, 3, 4, 5});
    surface.point_fields = {{"a b", values}, {"a_b", values}, {"x", values}, {"", values}, {"a b", values}};
    const Folder folder;
    const auto report = write(surface, folder / "out.ply");
    EXPECT_EQ(report.notes.size(), 6U); // two for names taken in any format, four for words
    const auto back = read_surface(folder / "out.ply");
    ASSERT_TRUE(back) << back.error().message;
    for (const auto* name : {"a_b", "a_b_2", "x_2", "field", "a_b_2_2"})
        EXPECT_TRUE(find_field(back->surface.point_fields, name)) << name;
}

TEST(WriteVtp, GivesFieldsOfOneNameTwoNamesAndSaysSo) {
    Surface surface = rich_surface();
    surface.point_fields[1].name = "pressure";
    surface.point_fields[2].name = "edge_ends";
    const Folder folder;
    const auto report = write(surface, folder / "out.vtp");
    EXPECT_TRUE(has_note(report, "\"pressure_2\""));
    EXPECT_TRUE(has_note(report, "\"edge_ends_2\""));
    const auto back = read_surface(folder / "out.vtp");
    ASSERT_TRUE(back) << back.error().message;
    expect_same(back->surface.edge_ends, surface.edge_ends, "edge ends");
    EXPECT_TRUE(find_field(back->surface.point_fields, "edge_ends_2"));
}

/// Of several blocks.
Surface long_surface() {
    constexpr std::size_t count = 200'000;
    std::vector<float> positions(3 * count), field(count);
    std::vector<std::uint32_t> triangles;
    for (std::size_t i = 0; i < count; ++i) {
        for (std::size_t axis = 0; axis < 3; ++axis)
            positions[3 * i + axis] = std::sin(static_cast<float>(i * (axis + 1)));
        field[i] = static_cast<float>(i % 1000);
        for (std::size_t k = 0; k < 3; ++k) triangles.push_back(static_cast<std::uint32_t>((i + k) % count));
    }
    Surface surface;
    surface.positions = Array::own(std::move(positions), 3);
    surface.triangles = Array::own(std::move(triangles), 3);
    surface.point_fields = {{"field", Array::own(std::move(field))}};
    return surface;
}

TEST(CompressedVtp, IsReadBackAsItWasAndIsTheSameFromAnyNumberOfThreads) {
    const Surface rich = rich_surface(), large = long_surface(), empty;
    for (const Surface* surface : {&rich, &large, &empty})
        for (const Compression compression : {Compression::zlib, Compression::lz4}) {
            const Folder folder;
            ASSERT_TRUE(write_surface(*surface, folder / "plain.vtp"));
            for (const int threads : {1, 3}) {
                const auto report = write_surface(*surface, folder / (std::to_string(threads) + ".vtp"),
                                                  {.compression = compression}, {.threads = threads});
                ASSERT_TRUE(report) << report.error().message;
                EXPECT_EQ(report->bytes, std::filesystem::file_size(folder / (std::to_string(threads) + ".vtp")));
            }
            EXPECT_TRUE(content_of(folder / "1.vtp") == content_of(folder / "3.vtp"));
            const auto back = read_surface(folder / "1.vtp"), plain = read_surface(folder / "plain.vtp");
            ASSERT_TRUE(back) << back.error().message;
            ASSERT_TRUE(plain) << plain.error().message;
            expect_same(back->surface.positions, plain->surface.positions, "positions");
            expect_same(back->surface.triangles, plain->surface.triangles, "triangles");
            ASSERT_EQ(back->surface.point_fields.size(), plain->surface.point_fields.size());
            for (std::size_t i = 0; i < back->surface.point_fields.size(); ++i)
                expect_same(back->surface.point_fields[i].values, plain->surface.point_fields[i].values, "field");
            if (surface == &large) {
                EXPECT_LT(std::filesystem::file_size(folder / "1.vtp"),
                          std::filesystem::file_size(folder / "plain.vtp"));
            }
        }
}

TEST(CompressedVtp, IsTheOnlyFormatOfSurfacesWithCompression) {
    const Folder folder;
    for (const std::string& format : all_formats) {
        const auto report = write_surface(bare_surface(), folder / "out", {format, Compression::zlib});
        EXPECT_EQ(static_cast<bool>(report), format == "vtp");
        if (report) continue;
        EXPECT_EQ(report.error().code, ErrorCode::invalid_argument);
        EXPECT_EQ(report.error().message, "zlib compression was asked for, but " + format + " has none: vtp has");
    }
}

TEST(CompressedVtp, LeavesNoFileWhenCancelled) {
    const Folder folder;
    const std::atomic<bool> cancel{true};
    Progress progress;
    progress.cancel = &cancel;
    const auto report =
        write_surface(long_surface(), folder / "out.vtp", {.compression = Compression::lz4}, {.progress = progress});
    ASSERT_FALSE(report);
    EXPECT_EQ(report.error().code, ErrorCode::cancelled);
    EXPECT_EQ(folder.entries(), 0U);
}

TEST(WriteStl, HoldsTrianglesAsSoupWithFacetNormals) {
    const Surface surface = bare_surface(), back = written_and_read(surface, "stl");
    ASSERT_EQ(back.vertex_count(), 9U);
    ASSERT_EQ(back.triangle_count(), 3U);
    const auto corners = surface.triangles.as<std::uint32_t>();
    for (std::size_t i = 0; i < corners.size(); ++i) {
        for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(back.positions.at(i, k), surface.positions.at(corners[i], k));
    }
    ASSERT_EQ(back.normals_kind, Normals::face);
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_NEAR(std::hypot(back.normals.at(i, 0), back.normals.at(i, 1), back.normals.at(i, 2)), 1, 1e-6);
        EXPECT_GT(back.normals.at(i, 2), 0.9);
    }
}

TEST(WriteStl, TakesTheNormalsOfFacesWhereThereAreAny) {
    const Surface surface = with_normals(bare_surface(), Normals::face);
    expect_same(written_and_read(surface, "stl").normals, surface.normals, "normals");
}

TEST(WriteStl, SaysWhatItLeftOut) {
    const Folder folder;
    EXPECT_TRUE(has_note(write(rich_surface(), folder / "out.stl"), "\"pressure\""));
}

TEST(WriteStl, KeepsCoordinatesFarFromZeroWhereTrianglesStayWhole) {
    const Surface surface = moved(bare_surface(), {4300000, 0, 0.5});
    const Folder folder;
    const auto report = write(surface, folder / "out.stl");
    EXPECT_FALSE(has_note(report, "relative"));
    const auto back = read_surface(folder / "out.stl");
    ASSERT_TRUE(back);
    EXPECT_EQ(back->surface.positions.at(1, 0), 4300001);
    EXPECT_EQ(back->surface.positions.at(1, 2), static_cast<float>(surface.positions.at(1, 2)));
}

/// At 4e8 float32 has steps of 32.
TEST(WriteStl, MovesWhereTrianglesWouldCollapse) {
    Surface surface = bare_surface();
    surface.positions = Array::own(std::vector<float>{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 2, 0, 1}, 3);
    surface = moved(surface, {400000000, 400000000, 400000000});
    const Folder folder;
    const auto report = write(surface, folder / "out.stl");
    EXPECT_TRUE(has_note(report, "coordinates are relative to (400000000, 400000000, 400000000)"));
    const auto back = read_surface(folder / "out.stl");
    ASSERT_TRUE(back);
    EXPECT_EQ(back->surface.positions.at(1, 0), 1);
}

TEST(WriteStl, SaysWhenItRounds) {
    Surface surface = bare_surface();
    surface.positions = Array::own(std::vector<double>{0, 0, 0, 4200000.1, 0, 0, 1, 1, 0, 0, 1, 0, 2, 0, 0}, 3);
    const Folder folder;
    EXPECT_TRUE(has_note(write(surface, folder / "out.stl"), "rounded by up to 0.1"));
}

class TextFormat : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Formats, TextFormat, testing::Values("obj", "ts"));

TEST_P(TextFormat, GivesBackTheSameFloats) {
    const Surface surface = bare_surface(), back = written_and_read(surface, GetParam());
    expect_same(back.triangles, surface.triangles, "triangles");
    std::vector<float> positions;
    for (const double value : doubles_of(back.positions)) positions.push_back(static_cast<float>(value));
    expect_same(Array::own(std::move(positions), 3), surface.positions, "positions");
}

TEST_P(TextFormat, GivesBackTheSameDoubles) {
    const Surface surface = moved(bare_surface(), {4200000.125, -0.1, 1e-9});
    expect_same(written_and_read(surface, GetParam()).positions, surface.positions, "positions");
}

TEST(WriteObj, GivesBackNormalsOfVerticesAndFaces) {
    for (const auto kind : {Normals::gradient, Normals::face}) {
        const Surface surface = with_normals(bare_surface(), kind), back = written_and_read(surface, "obj");
        EXPECT_EQ(back.normals_kind, kind);
        expect_same(back.normals, surface.normals, "normals");
    }
}

TEST(WriteTs, GivesBackPropertiesWithNoData) {
    Surface surface = rich_surface();
    surface.point_fields[2].values =
        Array::own(std::vector<double>{1, -99999, -999999, 4, 5, 6, 7, 8, 9, 0.1, 0.2, 0.3, 1e300, NAN, 0}, 3);
    const Surface back = written_and_read(surface, "ts");
    ASSERT_EQ(back.point_fields.size(), 4U);
    EXPECT_EQ(back.point_fields[0].name, "pressure");
    EXPECT_TRUE(std::isnan(back.point_fields[0].values.at(2)));
    EXPECT_EQ(static_cast<float>(back.point_fields[0].values.at(4)), 0.1F);
    EXPECT_EQ(back.point_fields[1].name, "temperature (K) [mean]");
    EXPECT_EQ(back.point_fields[1].values.at(0), 298.125);
    expect_same(back.point_fields[2].values, surface.point_fields[2].values, "velocity");
    EXPECT_EQ(back.point_fields[3].name, "caf%E9 %01<&%22'>");
}

class EveryFormat : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Formats, EveryFormat, testing::ValuesIn(all_formats));

TEST_P(EveryFormat, HoldsAnEmptySurface) {
    const Surface back = written_and_read(empty_surface(), GetParam());
    EXPECT_EQ(back.vertex_count(), 0U);
    EXPECT_EQ(back.triangle_count(), 0U);
    written_and_read(Surface{}, GetParam());
}

TEST_P(EveryFormat, IsTheSameBytesEveryTime) {
    const Folder folder;
    write(rich_surface(), folder / ("a." + GetParam()));
    write(rich_surface(), folder / ("b." + GetParam()));
    EXPECT_TRUE(content_of(folder / ("a." + GetParam())) == content_of(folder / ("b." + GetParam())));
}

TEST_P(EveryFormat, HoldsMoreThanOnePieceInOrder) {
    // More rows than are made at once, so that pieces made in parallel have to be put in order.
    constexpr std::uint32_t count = 1200000;
    std::vector<float> positions(3 * count);
    std::vector<std::uint32_t> triangles(count);
    for (std::uint32_t i = 0; i < count; ++i) {
        positions[3 * i] = static_cast<float>(i);
        triangles[i] = count - 1 - i;
    }
    Surface surface;
    surface.positions = Array::own(std::move(positions), 3);
    surface.triangles = Array::own(std::move(triangles), 3);
    const Surface back = written_and_read(surface, GetParam());
    ASSERT_EQ(back.triangle_count(), count / 3);
    bool same = true;
    for (std::uint32_t i = 0; i < count; ++i) {
        same = same && back.positions.at(static_cast<std::size_t>(back.triangles.at(i / 3, i % 3)), 0) == count - 1 - i;
    }
    EXPECT_TRUE(same);
}

TEST_P(EveryFormat, RefusesASurfaceWithAVertexThatIsNotThere) {
    Surface surface = bare_surface();
    surface.triangles = Array::own(std::vector<std::uint32_t>{0, 1, 2, 0, 5, 3}, 3);
    const Folder folder;
    const auto report = write_surface(surface, folder / ("out." + GetParam()));
    ASSERT_FALSE(report);
    EXPECT_EQ(report.error().code, ErrorCode::invalid_data);
    EXPECT_EQ(report.error().message, "triangles[1] has vertex 5, but the surface has 5 vertices");
    EXPECT_EQ(folder.entries(), 0U);
}

TEST_P(EveryFormat, LeavesNoFileWhenCancelled) {
    const Folder folder;
    const std::atomic<bool> cancel{true};
    Progress progress;
    progress.cancel = &cancel;
    const auto report = write_surface(rich_surface(), folder / ("out." + GetParam()), {}, {.progress = progress});
    ASSERT_FALSE(report);
    EXPECT_EQ(report.error().code, ErrorCode::cancelled);
    EXPECT_EQ(folder.entries(), 0U);
}

TEST(WriteSurface, ReportsProgressUpToTheEnd) {
    const Folder folder;
    double last = -1;
    bool rises = true;
    Progress progress;
    progress.report = [&](std::string_view, double fraction) {
        rises = rises && fraction >= last;
        last = fraction;
    };
    ASSERT_TRUE(write_surface(rich_surface(), folder / "out.vtp", {}, {.progress = progress}));
    EXPECT_TRUE(rises);
    EXPECT_EQ(last, 1.0);
}

TEST(WriteSurface, TakesTheFormatFromTheEndingUnlessGiven) {
    const Folder folder;
    ASSERT_TRUE(write_surface(bare_surface(), folder / "UPPER.PLY"));
    EXPECT_TRUE(content_of(folder / "UPPER.PLY").starts_with("ply\n"));
    ASSERT_TRUE(write_surface(bare_surface(), folder / "out.ply", {"vtk"}));
    EXPECT_TRUE(content_of(folder / "out.ply").starts_with("# vtk"));
    for (const auto& [path, format] : {std::pair{"out.xyz", ""}, {"out", ""}, {"out.ply", "xyz"}, {"a.ply/out", ""}}) {
        const auto report = write_surface(bare_surface(), folder / path, {format});
        ASSERT_FALSE(report) << path;
        EXPECT_EQ(report.error().code, ErrorCode::invalid_argument);
        EXPECT_NE(report.error().message.find("vtp, ply, stl, obj, vtk, ts"), std::string::npos);
    }
}

TEST(WriteSurface, RefusesArraysThatDoNotFit) {
    const Folder folder;
    const auto refused = [&](const Surface& surface) {
        const auto report = write_surface(surface, folder / "out.vtp");
        return !report && report.error().code == ErrorCode::invalid_argument;
    };
    Surface surface = rich_surface();
    surface.point_fields[0].values = Array::own(std::vector<float>{1});
    EXPECT_TRUE(refused(surface));
    surface = rich_surface();
    surface.source_cells = Array::own(std::vector<float>{1, 2, 3});
    EXPECT_TRUE(refused(surface));
    surface = rich_surface();
    surface.positions = Array::own(std::vector<std::int32_t>(15), 3);
    EXPECT_TRUE(refused(surface));
    surface = rich_surface();
    surface.positions = Array::own(std::vector<float>(10), 2);
    EXPECT_TRUE(refused(surface));
    surface = rich_surface();
    surface.normals_kind = Normals::face;
    EXPECT_TRUE(refused(surface));
    EXPECT_EQ(folder.entries(), 0U);
}

} // namespace
} // namespace isotet::test
