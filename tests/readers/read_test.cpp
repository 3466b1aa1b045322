// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// isotet::read() and isotet::inspect(): which reader takes a file, and what is checked whoever reads.
#include <isotet/read.hpp>

#include <sys/stat.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <tuple>

#include <gtest/gtest.h>

#include "readers/gmsh_sample.hpp"
#include "readers/gocad_sample.hpp"
#include "readers/grdecl_sample.hpp"
#include "readers/medit_sample.hpp"
#include "readers/sample_bytes.hpp"

namespace isotet::test {
namespace {

namespace fs = std::filesystem;
using namespace std::string_view_literals;

/// A folder for one test, gone afterwards.
class ReadFile : public testing::Test {
protected:
    void SetUp() override {
        folder_ = (fs::temp_directory_path() / "isotet-read-XXXXXX").string();
        ASSERT_NE(::mkdtemp(folder_.data()), nullptr);
    }
    void TearDown() override { fs::remove_all(folder_); }

    std::string path(const std::string& name) const { return folder_ + "/" + name; }
    std::string write(const std::string& name, std::string_view content) const {
        std::ofstream(path(name), std::ios::binary) << content;
        return path(name);
    }

private:
    std::string folder_;
};

std::string format_of(const std::string& path) {
    const auto info = inspect(path);
    return info ? info->format : info.error().message;
}

const std::string nodes = "4 3 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n", elements = "1 4 0\n1 1 2 3 4\n";

TEST_F(ReadFile, IsRecognizedByItsContentWhateverItsName) {
    EXPECT_EQ(format_of(write("a", gmsh_sample({}))), "gmsh");
    EXPECT_EQ(format_of(write("b.msh", medit_sample({}))), "medit");
    EXPECT_EQ(format_of(write("c.bin", medit_sample({4, true}))), "medit");
    EXPECT_EQ(format_of(write("d.mesh", gocad_sample)), "gocad");
}

TEST_F(ReadFile, IsRecognizedByItsNameWhereTheContentSaysNothing) {
    write("a.node", nodes);
    write("a.ele", elements);
    EXPECT_EQ(format_of(path("a.node")), "tetgen");
    EXPECT_EQ(format_of(path("a.ele")), "tetgen");
    write("B.NODE", nodes);
    write("B.ELE", elements);
    EXPECT_EQ(format_of(path("B.NODE")), "tetgen");
    EXPECT_EQ(format_of(path("B.ELE")), "tetgen");
    for (const auto& [there, missing] : {std::pair("c.node", "c.ele"), {"d.ele", "d.node"}})
        EXPECT_NE(format_of(write(there, nodes)).find(std::string(missing) + " is not there: TetGen has points"),
                  std::string::npos);
    EXPECT_EQ(read(path("a.ele")).value().grid.cells.count(), 1U);
}

TEST_F(ReadFile, IsReadByTheFormatAskedFor) {
    ReadOptions options;
    options.format = "gocad";
    const auto result = inspect(write("a.msh", gmsh_sample({})), options);
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().code, ErrorCode::invalid_data);
    options.format = "gmesh";
    const auto unknown = read(path("a.msh"), options);
    ASSERT_FALSE(unknown);
    EXPECT_EQ(unknown.error().code, ErrorCode::invalid_argument);
    EXPECT_EQ(unknown.error().message.find("format 'gmesh' is not one that isotet reads; formats are gmsh"), 0U);
}

TEST_F(ReadFile, OfNoKnownFormatIsAnErrorThatListsTheFormats) {
    const auto result = read(write("a.dat", "just\x01 text"));
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().code, ErrorCode::file);
    EXPECT_NE(result.error().message.find("it begins with 'just\\x01 text', its name ends in '.dat'"),
              std::string::npos);
    EXPECT_NE(result.error().message.find("tetgen"), std::string::npos);
}

TEST_F(ReadFile, MayBeginWithAByteOrderMark) {
    const std::string mark = "\xef\xbb\xbf";
    EXPECT_EQ(format_of(write("a.msh", mark + gmsh_sample({}))), "gmsh");
    EXPECT_EQ(format_of(write("b.txt", mark + medit_sample({}))), "medit");
    EXPECT_EQ(format_of(write("c.vtk", mark + "# vtk DataFile Version 3.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\n")),
              "vtk");
    write("d.node", mark + nodes);
    write("d.ele", mark + elements);
    write("e.grdecl", mark + "INCLUDE\n e.inc /\n");
    write("e.inc", mark + grdecl_sample());
    for (const char* name : {"a.msh", "b.txt", "d.node", "e.grdecl"}) {
        const auto result = read(path(name));
        EXPECT_TRUE(result) << name << ": " << result.error().message;
    }
}

TEST_F(ReadFile, InUtf16IsNamedAsThat) {
    const std::string text = "# vtk DataFile";
    std::string little = "\xff\xfe", big = "\xfe\xff";
    for (const char c : text) {
        little += {c, '\0'};
        big += {'\0', c};
    }
    for (const std::string& bytes : {little, big}) {
        const auto result = read(write("a.vtk", bytes));
        ASSERT_FALSE(result);
        EXPECT_NE(result.error().message.find("is text in UTF-16"), std::string::npos) << result.error().message;
    }
}

TEST_F(ReadFile, ThatIsPackedOrAPointerOrOfAnotherProgramIsNamed) {
    const auto message = [&](const std::string& name, std::string_view content) {
        const auto result = read(write(name, content));
        return result ? "no error" : result.error().message;
    };
    EXPECT_NE(message("a.vtu.gz", "\x1f\x8b\x08 and more").find("is packed by gzip"), std::string::npos);
    EXPECT_NE(message("a.vtu", "version https://git-lfs.github.com/spec/v1\noid").find("is a pointer of Git LFS"),
              std::string::npos);
    EXPECT_NE(message("a.inp", "\n** made\n*NODE\n").find("Abaqus or CalculiX"), std::string::npos);
    EXPECT_NE(message("a.mesh", "MFEM mesh v1.0\n\ndimension\n3\n").find("MFEM's own mesh"), std::string::npos);
    EXPECT_NE(message("a.szplt", "#!SZPLT").find("a Tecplot file"), std::string::npos);
    EXPECT_NE(message("a.dat", "TITLE = \"x\"\n").find("a Tecplot file"), std::string::npos);
    EXPECT_NE(message("a.su2", "NDIME= 3\n").find("a mesh of SU2"), std::string::npos);
    EXPECT_NE(message("a.stl", "solid x\n").find("is a surface"), std::string::npos);
    for (const auto& [name, content, is] : {
             std::tuple("a.msh", " (1 \"TGrid\")\n(2 2)\n"sv, "a mesh of Fluent"),
             {"a.msh", " 112 184 40\n 4.0 8.0E-01 1\n"sv, "a mesh of FreeFem"},
             {"a.msh", "MESH dimension 3 ElemType Hexahedra Nnode 8\n"sv, "a mesh of GiD"},
             {"a.msh", "*NODE, NSET=Nall\n"sv, "a mesh of CalculiX"},
             {"a.vol", "# Generated by NETGEN\n\nmesh3d\ndimension\n3\n"sv, "Netgen's own mesh"},
             {"a.cas.h5", "\x89HDF\r\n\x1a\n meshes\0 settings\0"sv, "an HDF5 file of Fluent"},
             {"a.hdf", "\x89HDF\r\n\x1a\n STUDY_STRUCTURE"sv, "a study of Salome"},
             {"a.h5", "\x89HDF\r\n\x1a\n data"sv, "an HDF5 file"},
             {"a.silo", "!<<PDB:II>>!\n"sv, "a Silo file"},
             {"a",
              "\0\0\0\x10"
              "FILEHEAD\0\0\0\x64INTE\0\0\0\x10"sv,
              "a binary file of Eclipse"},
             {"a.neu", "        CONTROL INFO 1.2.1\n"sv, "a neutral file of Gambit"},
             {"a.nc", "CDF\1 Conventions UGRID"sv, "a NetCDF file of 2D cells (UGRID)"},
             {"a.nc", "CDF\1 Conventions CF"sv, "a NetCDF file"},
             {"a.xyz", "1\n2 3 2\n0.5 1 1\n"sv, "a PLOT3D file"},
             {"a.q", "\4\0\0\0\2\0\0\0"sv, "a PLOT3D file"},
         })
        EXPECT_NE(message(name, content).find(std::string("is ") + is), std::string::npos) << message(name, content);
    EXPECT_NE(message("a.msh", "1 2 3\n").find("no $MeshFormat"), std::string::npos);
    EXPECT_NE(message("a.xyz", "1 2 3\n").find("has no format that isotet reads"), std::string::npos);
}

TEST_F(ReadFile, ThatIsNoPlainFileOrEmptyIsAnError) {
    EXPECT_EQ(read(path("missing.msh")).error().code, ErrorCode::file);
    EXPECT_EQ(read(write("empty.msh", "")).error().code, ErrorCode::file);
    EXPECT_EQ(read(path("")).error().code, ErrorCode::file);
    ASSERT_EQ(::mkfifo(path("pipe.msh").c_str(), 0600), 0);
    const auto pipe = read(path("pipe.msh"));
    ASSERT_FALSE(pipe);
    EXPECT_EQ(pipe.error().message, path("pipe.msh") + " is a pipe, but only files can be read");
}

TEST_F(ReadFile, WithAMissingPartNamesThePart) {
    const auto result = read(write("a.node", nodes));
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().code, ErrorCode::file);
    EXPECT_NE(result.error().message.find("a.ele"), std::string::npos);
}

TEST_F(ReadFile, TakesTheSolutionBesideAMesh) {
    write("a.mesh", medit_sample({}));
    EXPECT_EQ(inspect(path("a.mesh")).value().fields.size(), 2U);
    write("a.solb", medit_solution_sample({2, false}));
    EXPECT_EQ(inspect(path("a.mesh")).value().fields.size(), 5U);
    EXPECT_EQ(read(path("a.mesh")).value().grid.point_fields.size(), 4U);
}

TEST_F(ReadFile, ThatIsBrokenIsNamedInTheError) {
    const std::string file = write("a.msh", "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n");
    EXPECT_EQ(read(file).error().message, file + ": has no $Elements section");
    EXPECT_EQ(read(file).error().code, ErrorCode::invalid_data);
}

TEST_F(ReadFile, WithACoordinateThatIsNotFiniteIsAnError) {
    const std::string file = write("a.node", "4 3 0 0\n1 0 0 0\n2 nan 0 0\n3 0 1 0\n4 0 0 1\n");
    write("a.ele", elements);
    const auto result = read(file);
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().code, ErrorCode::invalid_data);
    EXPECT_EQ(result.error().message.find(file + ": points[1] has x coordinate nan"), 0U);
}

TEST_F(ReadFile, WithoutTheFieldAskedForListsTheFieldsNearestFirst) {
    ReadOptions options;
    options.point_fields = {"temprature"};
    const auto result = read(write("a.msh", gmsh_sample({})), options);
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().code, ErrorCode::invalid_argument);
    EXPECT_EQ(result.error().message, "point field 'temprature' is not in the file, which has 'temperature', 'flow'");
    options.point_fields.emplace();
    options.cell_fields = {"temperature"};
    EXPECT_EQ(read(path("a.msh"), options).error().message.find("cell field 'temperature' is not in the file"), 0U);
}

TEST_F(ReadFile, WithoutTheStepAskedForSaysHowManyThereAre) {
    ReadOptions options;
    options.step = 7;
    const auto result = read(write("a.msh", gmsh_sample({})), options);
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().code, ErrorCode::invalid_argument);
    EXPECT_EQ(result.error().message, "step 7 is not there, but the file has 2 steps, counted from 0");
    write("b.mesh", medit_sample({}));
    EXPECT_FALSE(read(path("b.mesh"), options));
    options.step = 0;
    EXPECT_TRUE(read(path("b.mesh"), options));
}

TEST_F(ReadFile, IsDisplacedInDoubleAndNoted) {
    const std::string file = write("a.mesh", medit_sample({}));
    write("a.sol", medit_solution_sample({}));
    ReadOptions options;
    options.displace = "sol_1";
    options.point_fields.emplace();
    const ReadResult result = read(file, options).value();
    EXPECT_TRUE(result.grid.point_fields.empty()) << "nobody asked for the displacement itself";
    for (std::size_t n = 0; n < 9; ++n) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            EXPECT_EQ(result.grid.points.at(n, axis),
                      cube_points[3 * n + axis] + static_cast<double>(n) + 0.25 * static_cast<double>(axis));
        }
    }
    EXPECT_EQ(result.notes, std::vector<std::string>{"points are displaced by the field 'sol_1'"});
}

TEST_F(ReadFile, IsNotDisplacedByAScalar) {
    write("a.mesh", medit_sample({}));
    write("a.sol", medit_solution_sample({}));
    ReadOptions options;
    options.displace = "sol";
    const auto result = read(path("a.mesh"), options);
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().code, ErrorCode::invalid_argument);
    EXPECT_EQ(result.error().message, "field 'sol' has 1 components, but displacing takes a point field of 3");
}

TEST(Formats, AreNamedOnceAndHaveExtensions) {
    std::vector<std::string> names;
    for (const Format& format : formats()) {
        EXPECT_FALSE(format.title.empty()) << format.name;
        EXPECT_TRUE(format.reads_grid || format.writes_grid || format.reads_surface || format.writes_surface)
            << format.name;
        for (const std::string& extension : format.extensions) EXPECT_EQ(extension.front(), '.') << format.name;
        names.push_back(format.name);
    }
    for (const char* name : {"gmsh", "medit", "tetgen", "gocad", "vtp", "ply", "stl", "obj", "ts", "vtk", "vtu"}) {
        EXPECT_EQ(std::count(names.begin(), names.end(), name), 1) << name;
    }
}

/// So many lines that both the mesh and its solution are reported on the way.
TEST_F(ReadFile, ReportsProgressThatNeverFallsFromOneFileToTheOther) {
    constexpr int points = 200'000;
    std::string mesh = "MeshVersionFormatted 2\nDimension 3\nVertices\n" + std::to_string(points) + "\n";
    std::string solution = "MeshVersionFormatted 2\nDimension 3\nSolAtVertices\n" + std::to_string(points) + "\n1 1\n";
    for (int i = 0; i < points; ++i) {
        mesh += i == 1 ? "1 0 0 0\n" : i == 2 ? "0 1 0 0\n" : i == 3 ? "0 0 1 0\n" : "0 0 0 0\n";
        solution += "1\n";
    }
    write("a.mesh", mesh + "Tetrahedra\n1\n1 2 3 4 0\nEnd\n");
    write("a.sol", solution + "End\n");
    std::vector<double> fractions;
    Progress progress;
    progress.report = [&](std::string_view, double fraction) { fractions.push_back(fraction); };
    const auto result = read(path("a.mesh"), {}, {.progress = progress});
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_GT(fractions.size(), 3u);
    EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
}

} // namespace
} // namespace isotet::test
