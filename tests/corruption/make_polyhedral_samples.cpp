// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Writes the samples of polyhedra in formats for which VTK has no writer that works: make_polyhedral_samples FOLDER
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

#include "vtk_readers/polyhedral_ensight.hpp"
#include "vtk_readers/polyhedral_exodus.hpp"

#include "vtk_readers/polyhedral_cgns.hpp" // last: its macros rename common words

int main(int argc, char** argv) {
    if (argc != 2) {
        std::puts("usage: make_polyhedral_samples FOLDER");
        return 2;
    }
    using namespace isotet::test;
    const std::string folder = std::string(argv[1]) + "/";
    const isotet::Grid all = all_polyhedra(octree_for_files());
    write_cgns(all, {}, folder + "cells.cgns");
    write_cgns(all, {.hdf5 = true, .face_sections = 2, .parents = true}, folder + "parents_hdf5.cgns");
    write_polyhedral_exodus(octree_for_files(), folder + "blocks.exo");
    write_polyhedral_exodus(octree_for_files(), folder + "blocks_hdf5.exo", EX_NETCDF4);
    const GoldFiles gold = polyhedral_ensight(octree_for_files(), GoldForm::c);
    std::filesystem::create_directories(folder + "ensight");
    for (const auto& [name, content] : {std::pair("a.case", &gold.case_file),
                                        {"grid.geo", &gold.geometry},
                                        {"f.scl", &gold.f},
                                        {"g.scl", &gold.g},
                                        {"c.scl", &gold.c}})
        std::ofstream(folder + "ensight/" + name, std::ios::binary) << *content;
    return testing::Test::HasFailure() ? 1 : 0;
}
