// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Surfaces and grids to write, and folders to write them into.
#pragma once

#include <bit>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include <stdlib.h>

#include <gtest/gtest.h>

#include <isotet/fields.hpp>
#include <isotet/grid.hpp>
#include <isotet/surface.hpp>
#include <isotet/write.hpp>

#include "support/temporary_folder.hpp"

namespace isotet::test {

/// A folder of its own for one test, removed with all that is in it.
class Folder {
public:
    Folder() {
        std::string name = (std::filesystem::temp_directory_path() / "isotet-files-XXXXXX").string();
        if (!::mkdtemp(name.data())) ADD_FAILURE() << "no temporary folder";
        path_ = name;
    }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    ~Folder() {
        std::error_code ignored;
        std::filesystem::permissions(path_, std::filesystem::perms::owner_all, ignored);
        std::filesystem::remove_all(path_, ignored);
    }

    std::string operator/(std::string_view name) const { return (path_ / name).string(); }
    const std::filesystem::path& path() const { return path_; }
    std::size_t entries() const {
        return static_cast<std::size_t>(
            std::distance(std::filesystem::directory_iterator(path_), std::filesystem::directory_iterator()));
    }

private:
    std::filesystem::path path_;
};

inline void put_content(const std::string& path, std::string_view content) {
    std::ofstream(path, std::ios::binary) << content;
}

/// The bits of an array's scalars, so that NaN equals itself and -0 is not +0.
inline std::vector<std::uint64_t> bits_of(const Array& array) {
    return array.visit([](auto values) {
        std::vector<std::uint64_t> bits;
        for (const auto value : values) {
            if constexpr (sizeof(value) == 8) bits.push_back(std::bit_cast<std::uint64_t>(value));
            else if constexpr (std::is_same_v<decltype(value), const float>)
                bits.push_back(std::bit_cast<std::uint32_t>(value));
            else bits.push_back(static_cast<std::uint64_t>(value));
        }
        return bits;
    });
}

inline std::vector<double> doubles_of(const Array& array) {
    return array.visit([](auto values) { return std::vector<double>(values.begin(), values.end()); });
}

inline void expect_same(const Array& a, const Array& b, std::string_view what) {
    EXPECT_EQ(a.type(), b.type()) << what;
    EXPECT_EQ(a.components(), b.components()) << what;
    EXPECT_EQ(bits_of(a), bits_of(b)) << what;
}

inline WriteReport write(const Surface& surface, const std::string& path) {
    auto report = write_surface(surface, path);
    EXPECT_TRUE(report) << report.error().message;
    return report ? *report : WriteReport{};
}

inline bool has_note(const WriteReport& report, std::string_view words) {
    for (const auto& note : report.notes) {
        if (note.find(words) != std::string::npos) return true;
    }
    return false;
}

inline const Field* find_field(const std::vector<Field>& fields, std::string_view name) {
    for (const auto& field : fields) {
        if (field.name == name) return &field;
    }
    return nullptr;
}

/// Two triangles and a third beside them, float32, no fields.
inline Surface bare_surface() {
    Surface surface;
    surface.positions =
        Array::own(std::vector<float>{0, 0, 0, 1, 0, 0.1F, 1, 1, 0, -0.0F, 1, 1e-30F, 2.5F, 0.3F, 1e20F}, 3);
    surface.triangles = Array::own(std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3, 1, 4, 2}, 3);
    return surface;
}

/// bare_surface() with fields of several types, names that give trouble, edge ends and source cells.
inline Surface rich_surface() {
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    Surface surface = bare_surface();
    surface.edge_ends = Array::own(std::vector<std::int64_t>{0, 7, 1, 8, 5000000000, 9, 3, 3, 4, 11}, 2);
    surface.edge_weights = Array::own(std::vector<float>{0.5F, 0.25F, 0.1F, 0, 1});
    surface.source_cells = Array::own(std::vector<std::int64_t>{12, 6000000000, 0});
    surface.point_fields = {
        {"pressure", Array::own(std::vector<float>{1, 2.5F, nan, -4, 0.1F})},
        {"temperature (K) [mean]", Array::own(std::vector<double>{298.125, 300.125, 302.125, 304.125, nan})},
        {"gmsh:velocity",
         Array::own(std::vector<double>{1, 2, 3, 4, 5, 6, 7, 8, 9, 0.1, 0.2, 0.3, 1e300, -1e-300, 0}, 3)},
        {"caf\xE9 \x01<&\"'>", Array::own(std::vector<std::int32_t>{1, -2, 3, -4, 5})},
    };
    surface.cell_fields = {
        {"region", Array::own(std::vector<std::uint8_t>{1, 2, 255})},
        {"big", Array::own(std::vector<std::int64_t>{-1, 9007199254740993, 3})},
    };
    return surface;
}

inline Surface empty_surface() {
    Surface surface;
    surface.positions = Array::own(std::vector<float>(), 3);
    surface.triangles = Array::own(std::vector<std::uint32_t>(), 3);
    surface.point_fields = {{"pressure", Array::own(std::vector<float>())}};
    surface.cell_fields = {{"region", Array::own(std::vector<std::uint8_t>())}};
    return surface;
}

/// Two tets as uniform cells.
inline Grid tet_grid() {
    Grid grid;
    grid.points = Array::own(std::vector<double>{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1.1}, 3);
    grid.cells.connectivity = Array::own(std::vector<std::int64_t>{0, 1, 2, 3, 1, 2, 3, 4});
    grid.point_fields = {{"field one", Array::own(std::vector<float>{1, 2, 3, 4, 5})}};
    grid.cell_fields = {{"v", Array::own(std::vector<double>{1, 2, 3, 4, 5, 6}, 3)}};
    return grid;
}

/// With float64 positions, moved by `shift`.
inline Surface moved(Surface surface, const std::array<double, 3>& shift) {
    std::vector<double> positions;
    for (std::size_t i = 0; i < surface.positions.size(); ++i)
        positions.push_back(surface.positions.at(i / 3, i % 3) + shift[i % 3]);
    surface.positions = Array::own(std::move(positions), 3);
    return surface;
}

/// A tet and a pyramid, with offsets that do not start at 0.
inline Grid mixed_grid() {
    Grid grid = tet_grid();
    grid.points = Array::own(std::vector<float>{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0.5F, 0.5F, 1}, 3);
    grid.cells.connectivity = Array::own(std::vector<std::uint32_t>{0, 0, 0, 1, 2, 4, 0, 1, 2, 3, 4});
    grid.cells.offsets = Array::own(std::vector<std::uint64_t>{2, 6, 11});
    grid.cells.types = Array::own(std::vector<std::uint8_t>{10, 14});
    return grid;
}

} // namespace isotet::test
