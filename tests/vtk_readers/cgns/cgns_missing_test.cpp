// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// CGNS files in HDF5 of which one array is gone, or shorter than it was: an error, or what nothing depends on.
#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <hdf5.h>

#include <isotet/read.hpp>

#include "support/places.hpp"
#include "support/temporary_folder.hpp"
#include "vtk_readers/vtk_digest.hpp"

namespace isotet::test {
namespace {

/// The names of all arrays of a file.
std::vector<std::string> arrays_in(const std::string& path) {
    const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    std::vector<std::string> names;
    const auto add = [](hid_t at, const char* name, const H5L_info_t*, void* to) -> herr_t {
        const hid_t object = H5Oopen(at, name, H5P_DEFAULT);
        if (H5Iget_type(object) == H5I_DATASET) static_cast<std::vector<std::string>*>(to)->emplace_back(name);
        H5Oclose(object);
        return 0;
    };
    H5Lvisit(file, H5_INDEX_NAME, H5_ITER_INC, add, &names);
    H5Fclose(file);
    return names;
}

hsize_t length_of(hid_t data) {
    const hid_t space = H5Dget_space(data);
    const auto length = static_cast<hsize_t>(H5Sget_simple_extent_npoints(space));
    H5Sclose(space);
    return length;
}

void remove_array(hid_t file, const std::string& name) { H5Ldelete(file, name.c_str(), H5P_DEFAULT); }

/// The first of its values, at its place.
void shorten_array(hid_t file, const std::string& name, hsize_t kept) {
    const hid_t data = H5Dopen2(file, name.c_str(), H5P_DEFAULT), type = H5Dget_type(data);
    std::vector<char> values(length_of(data) * H5Tget_size(type));
    H5Dread(data, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
    H5Dclose(data);
    remove_array(file, name);
    const hid_t space = H5Screate_simple(1, &kept, nullptr);
    const hid_t shorter = H5Dcreate2(file, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    H5Dwrite(shorter, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
    H5Dclose(shorter);
    H5Sclose(space);
    H5Tclose(type);
}

hsize_t length_in(hid_t file, const std::string& name) {
    const hid_t data = H5Dopen2(file, name.c_str(), H5P_DEFAULT);
    const hsize_t length = length_of(data);
    H5Dclose(data);
    return length;
}

/// How an array is changed.
enum class Change { removed, halved, shortened };

void change_array(hid_t file, const std::string& name, Change change) {
    if (change == Change::removed) return remove_array(file, name);
    const hsize_t length = length_in(file, name);
    shorten_array(file, name, change == Change::halved ? length / 2 : length - 1);
}

class CgnsWithoutAnArray : public testing::TestWithParam<Change> {};

TEST_P(CgnsWithoutAnArray, IsAnErrorOrTheSameGrid) {
    const std::string whole = (source_folder() / "data/cgns/wall_distance_hdf5.cgns").string();
    const auto sound = read(whole);
    ASSERT_TRUE(sound) << sound.error().message;
    const std::vector<std::string> expected = digest(sound->grid);
    const TemporaryFolder folder;
    std::vector<std::string> errors;
    int files = 0, fields_left_out = 0;
    for (const std::string& name : arrays_in(whole)) {
        const std::string path =
            folder.file("changed" + std::to_string(files++) + ".cgns"); // readers may hold the last one
        std::filesystem::copy_file(whole, path);
        const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
        change_array(file, name, GetParam());
        H5Fclose(file);
        const auto result = read(path);
        if (result) {
            if (result->info.left_out.empty()) {
                EXPECT_EQ(digest(result->grid), expected) << name;
                continue;
            }
            ASSERT_EQ(result->notes.size(), 1u) << name;
            EXPECT_EQ(result->notes[0].find("point field 'wallDistance' is left out: "), 0u) << result->notes[0];
            ++fields_left_out;
            continue;
        }
        errors.push_back(name + ": " + result.error().message);
        EXPECT_EQ(errors.back().find("signal"), std::string::npos) << "the reader crashed: " << errors.back();
        EXPECT_NE(errors.back().find(path), std::string::npos) << errors.back();
    }
    for (const char* needed : {"CoordinateX", "CoordinateY", "CoordinateZ", "ElementConnectivity"})
        EXPECT_TRUE(std::ranges::any_of(errors, [&](const std::string& error) {
            return error.find(needed) != std::string::npos;
        })) << needed;
    EXPECT_EQ(fields_left_out, 1);
}

INSTANTIATE_TEST_SUITE_P(Ways, CgnsWithoutAnArray, testing::Values(Change::removed, Change::halved, Change::shortened));

} // namespace
} // namespace isotet::test
