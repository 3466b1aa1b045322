// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Includes go one way: base, numbers, grid, packed, ops, engines, api, programs. Every source file of the tree is read.
#include <filesystem>
#include <fstream>
#include <map>
#include <string>

#include <gtest/gtest.h>

#include "includes/include_rules.hpp"
#include "support/places.hpp"

namespace isotet::test {
namespace {

namespace fs = std::filesystem;

bool is_source(const fs::path& path) {
    return path.extension() == ".hpp" || path.extension() == ".cpp" || path.extension() == ".h";
}

TEST(Includes, GoOnlyTheDirectionsOfTheArchitecture) {
    const fs::path root = source_folder();
    std::size_t includes = 0;
    for (const char* folder : {"include", "src", "apps", "bench", "examples", "python", "tests", "vtk"}) {
        if (!fs::exists(root / folder)) continue;
        for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
            if (!entry.is_regular_file() || !is_source(entry.path())) continue;
            const std::string path = entry.path().lexically_relative(root).generic_string();
            std::ifstream file(entry.path());
            std::string line;
            for (int number = 1; std::getline(file, line); ++number) {
                const std::string name = included_name(line);
                if (name.empty()) continue;
                ++includes;
                EXPECT_EQ(objection(path, name), "") << path << ":" << number << " includes " << name;
            }
        }
    }
    EXPECT_GT(includes, 100u) << "the check read nothing";
}

TEST(Includes, AgainstTheDirectionAreFound) {
    EXPECT_NE(objection("src/packed/build/pack.cpp", "ops/extract.hpp"), "");
    EXPECT_NE(objection("src/ops/extract.hpp", "cpu/emit.hpp"), "");
    EXPECT_NE(objection("src/cpu/emit.cpp", "reference/extract.hpp"), "");
    EXPECT_NE(objection("src/io/gmsh/read_gmsh.cpp", "cpu/emit.hpp"), "");
    EXPECT_NE(objection("src/io/gmsh/read_gmsh.cpp", "vtkCellArray.h"), "");
    EXPECT_NE(objection("src/io/process/formats.cpp", "io/confined/loaders.hpp"), "")
        << "the library does not know VTK";
    EXPECT_NE(objection("src/base/block.cpp", "grid/cells.hpp"), "");
    EXPECT_NE(objection("src/grid/faces.cpp", "packed/packed.hpp"), "");
    EXPECT_NE(objection("include/isotet/grid.hpp", "fmt/format.h"), "");
    EXPECT_NE(objection("src/base/parallel.hpp", "tbb/task_arena.h"), "");
    EXPECT_NE(objection("apps/cli/extract.cpp", "cpu/emit.hpp"), "");
    EXPECT_NE(objection("apps/cli/extract.cpp", "base/parallel.hpp"), "") << "the program sees public headers only";
    EXPECT_NE(objection("src/new_folder/new.cpp", "packed/packed.hpp"), "") << "a folder without a rule";
    EXPECT_NE(objection("src/grid/boundary_search.cpp", "isotet/linear_cells.hpp"), "") << "public headers have a room";
    EXPECT_NE(objection("src/session/contour.cpp", "isotet/jobs/job.hpp"), "");
    EXPECT_EQ(objection("src/fields/one_field.cpp", "isotet/linear_cells.hpp"), "");
    EXPECT_EQ(objection("src/cpu/emit.cpp", "ops/extract.hpp"), "");
    EXPECT_EQ(objection("src/io/confined/serve.cpp", "vtkCellArray.h"), "");
    EXPECT_NE(objection("python/bindings/contours.cpp", "session/fingerprint.hpp"), "") << "and so do the bindings";
    EXPECT_EQ(objection("apps/cli/extract.cpp", "isotet/extract.hpp"), "");
}

TEST(Includes, FoldersCanBeReadAtAGlance) {
    std::map<std::string, int> files;
    for (const char* folder :
         {"include", "src", "apps", "bench", "examples", "paraview", "python", "scripts", "tests", "vtk"})
        for (const auto& entry : fs::recursive_directory_iterator(source_folder() / folder))
            if (entry.is_regular_file() && entry.path().filename() != "CMakeLists.txt" &&
                entry.path().extension() != ".pyc")
                ++files[entry.path().parent_path().lexically_relative(source_folder()).generic_string()];
    EXPECT_GT(files.size(), 60u) << "the check read nothing";
    for (const auto& [folder, count] : files) EXPECT_LE(count, 40) << folder << " has too many files in it";
}

TEST(Includes, AreReadFromTheLinesThatAreIncludes) {
    EXPECT_EQ(included_name("  #  include <vector> // why"), "vector");
    EXPECT_EQ(included_name("#include \"grid/cells.hpp\""), "grid/cells.hpp");
    EXPECT_EQ(included_name("// #include <vector>"), "");
    EXPECT_EQ(included_name("#include NAME"), "");
}

} // namespace
} // namespace isotet::test
