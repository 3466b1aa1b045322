// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// One quadratic cell with a quadratic field, its nodes in the order that a format documents.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <isotet/linear_cells.hpp>

namespace isotet::test {

/// A cell as a format lists it: each node by the corners that it is the middle of.
struct CellInFile {
    std::string type; ///< the format's name or number
    int corners;
    std::vector<std::string> middles; ///< after the corners
};

using Position = std::array<double, 3>;

inline std::vector<Position> reference_corners(int corners) {
    switch (corners) {
    case 4: return {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    case 5: return {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 1}};
    case 6: return {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
    default: return {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
    }
}

inline double reference_volume(int corners) {
    return corners == 4 ? 1.0 / 6 : corners == 5 ? 1.0 / 3 : corners == 6 ? 0.5 : 1;
}

/// Of the reference cell's coordinates to the file's; the volume grows 1.5 times.
inline Position placed(Position u) { return {u[0] + 0.3 * u[1] + 2, u[1] + 0.2 * u[2], 1.5 * u[2] - 1}; }

/// A quadratic function of the place in the file.
inline double file_quadric(Position p) {
    const auto [x, y, z] = p;
    return x * x - 0.6 * y * y + 0.4 * z * z + 0.7 * x * y - 0.9 * y * z + 0.5 * z * x + 0.3 * y + 1;
}

/// The same, linear in z where the cell is.
inline double file_quadric_linear_upwards(Position p) {
    const double w = (p[2] + 1) / 1.5, v = p[1] - 0.2 * w, u = p[0] - 2 - 0.3 * v;
    return u * u - 0.6 * v * v + 0.7 * u * v + 0.4 * w + 1;
}

inline std::vector<Position> nodes_of(const CellInFile& cell) {
    const std::vector<Position> corners = reference_corners(cell.corners);
    std::vector<Position> out;
    for (const Position& corner : corners) out.push_back(placed(corner));
    for (const std::string& middle : cell.middles) {
        Position mean{};
        for (const char digit : middle)
            for (std::size_t k = 0; k < 3; ++k)
                mean[k] += corners[static_cast<std::size_t>(digit - '0')][k] / static_cast<double>(middle.size());
        out.push_back(placed(mean));
    }
    return out;
}

/// Wherever the cell is refined, the field is the quadratic one, and all of the cell is there: a node that is taken for
/// another breaks this.
inline void expect_exact(const Grid& grid, const Array& values, int corners, const std::string& what,
                         const std::function<double(Position)>& exact = file_quadric, double close = 1e-9) {
    ASSERT_EQ(values.tuples(), grid.points.tuples()) << what;
    RefineOptions options;
    options.tolerance = 0.003;
    const auto linear = refine(grid, {"f", values, false, {}}, options);
    ASSERT_TRUE(linear) << what << ": " << linear.error().message;
    EXPECT_EQ(linear->refinement.left_out, 0u) << what;
    EXPECT_GT(linear->refinement.tets, 40u) << what;
    const Array longer = linear->extend(values).value();
    const Array& points = linear->grid.points;
    for (std::size_t i = 0; i < points.tuples(); ++i)
        ASSERT_NEAR(longer.at(i), exact({points.at(i, 0), points.at(i, 1), points.at(i, 2)}), close) << what;
    double volume = 0;
    for (const auto& t : split(linear->grid).value().tets) {
        std::array<Position, 3> e{};
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t k = 0; k < 3; ++k) e[i][k] = points.at(t[i + 1], k) - points.at(t[0], k);
        volume += std::abs(e[0][0] * (e[1][1] * e[2][2] - e[1][2] * e[2][1]) -
                           e[0][1] * (e[1][0] * e[2][2] - e[1][2] * e[2][0]) +
                           e[0][2] * (e[1][0] * e[2][1] - e[1][1] * e[2][0])) /
                  6;
    }
    EXPECT_NEAR(volume, 1.5 * reference_volume(corners), close) << what;
}

/// VTK's types.
inline std::vector<CellInFile> vtk_cells() {
    const std::vector<std::string> tet{"01", "12", "20", "03", "13", "23"},
        hex{"01", "12", "23", "30", "45", "56", "67", "74", "04", "15", "26", "37"},
        faces{"0374", "1265", "0154", "3267", "0123", "4567"}, wedge{"01", "12", "20", "34", "45", "53"},
        pyramid{"01", "12", "23", "30", "04", "14", "24", "34"};
    const auto with = [](std::vector<std::string> first, const std::vector<std::string>& more, std::size_t count) {
        first.insert(first.end(), more.begin(), more.begin() + static_cast<std::ptrdiff_t>(count));
        return first;
    };
    const auto whole = with(with(hex, faces, 6), {"01234567"}, 1);
    const auto upright = with(wedge, {"03", "14", "25"}, 3), square = with(upright, {"0143", "1254", "2035"}, 3);
    const auto based = with(pyramid, {"0123"}, 1);
    return {{"24", 4, tet},
            {"25", 8, hex},
            {"26", 6, upright},
            {"27", 5, pyramid},
            {"29", 8, whole},
            {"31", 6, wedge},
            {"32", 6, square},
            {"33", 8, with(hex, faces, 4)},
            {"37", 5, with(based, {"014", "124", "234", "304", "01234"}, 5)},
            {"71", 4, tet},
            {"72", 8, whole},
            {"73", 6, square},
            {"74", 5, based}};
}

/// The field that a type of VTK's holds exactly.
inline std::function<double(Position)> vtk_field(const CellInFile& cell) {
    return cell.type == "31" ? file_quadric_linear_upwards : file_quadric;
}

} // namespace isotet::test
