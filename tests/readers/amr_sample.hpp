// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Overlapping boxes with a field in their cells, as VTH.
#pragma once

#include <array>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "io/amr/lattice.hpp"

namespace isotet::test {

using Value = std::function<double(const std::array<double, 3>&)>;

/// The middles of a box's cells, x fastest.
inline std::vector<std::array<double, 3>> middles_of(const io::amr::Hierarchy& all, std::size_t level,
                                                     const io::amr::CellBox& box) {
    std::vector<std::array<double, 3>> out;
    io::amr::Place cell;
    for (cell[2] = box.first[2]; cell[2] <= box.last[2]; ++cell[2])
        for (cell[1] = box.first[1]; cell[1] <= box.last[1]; ++cell[1])
            for (cell[0] = box.first[0]; cell[0] <= box.last[0]; ++cell[0]) {
                std::array<double, 3>& middle = out.emplace_back();
                for (std::size_t axis = 0; axis < 3; ++axis)
                    middle[axis] =
                        all.origin[axis] + all.levels[level].spacing[axis] * (static_cast<double>(cell[axis]) + 0.5);
            }
    return out;
}

/// What a file may have besides; what tests break.
struct AmrFile {
    io::amr::Hierarchy boxes;
    Value value = [](const std::array<double, 3>& p) { return p[0]; };
    std::vector<std::vector<int>> ghosts = {}; ///< of each box, or empty
    std::function<std::string(std::string)> changed_index = [](std::string text) { return text; };
    double moved_image = 0; ///< the first one, along x

    std::string write(const std::filesystem::path& folder) const {
        std::string index =
            fmt::format("<VTKFile type=\"vtkOverlappingAMR\" version=\"1.1\"><vtkOverlappingAMR origin=\"{} "
                        "{} {}\" grid_description=\"XYZ\">\n",
                        boxes.origin[0], boxes.origin[1], boxes.origin[2]);
        std::size_t number = 0;
        for (std::size_t level = 0; level < boxes.levels.size(); ++level) {
            const auto& spacing = boxes.levels[level].spacing;
            index +=
                fmt::format("<Block level=\"{}\" spacing=\"{} {} {}\">\n", level, spacing[0], spacing[1], spacing[2]);
            for (const io::amr::CellBox& box : boxes.levels[level].boxes) {
                index += fmt::format("<DataSet amr_box=\"{} {} {} {} {} {}\" file=\"{}.vti\"/>\n", box.first[0],
                                     box.last[0], box.first[1], box.last[1], box.first[2], box.last[2], number);
                write_image(folder / fmt::format("{}.vti", number), level, box, number);
                ++number;
            }
            index += "</Block>\n";
        }
        const std::filesystem::path path = folder / "a.vth";
        std::ofstream(path) << changed_index(index + "</vtkOverlappingAMR></VTKFile>\n");
        return path.string();
    }

private:
    void write_image(const std::filesystem::path& path, std::size_t level, const io::amr::CellBox& box,
                     std::size_t number) const {
        const auto& spacing = boxes.levels[level].spacing;
        const std::string extent = fmt::format("0 {} 0 {} 0 {}", box.cells(0), box.cells(1), box.cells(2));
        std::string text = fmt::format("<VTKFile type=\"ImageData\"><ImageData WholeExtent=\"{}\" Spacing=\"{} {} {}\" "
                                       "Origin=\"",
                                       extent, spacing[0], spacing[1], spacing[2]);
        for (std::size_t axis = 0; axis < 3; ++axis)
            text += fmt::format("{} ", boxes.origin[axis] + spacing[axis] * static_cast<double>(box.first[axis]) +
                                           (number == 0 && axis == 0 ? moved_image : 0));
        text += fmt::format(
            "\"><Piece Extent=\"{}\"><CellData><DataArray type=\"Float64\" Name=\"s\" format=\"ascii\">", extent);
        for (const auto& middle : middles_of(boxes, level, box)) text += fmt::format("{} ", value(middle));
        text += "</DataArray>";
        if (!ghosts.empty() && !ghosts[number].empty())
            text += fmt::format("<DataArray type=\"UInt8\" Name=\"vtkGhostType\" format=\"ascii\">{}</DataArray>",
                                fmt::join(ghosts[number], " "));
        std::ofstream(path) << text << "</CellData></Piece></ImageData></VTKFile>\n";
    }
};

/// A cube of 2 n cells a side from -1 to 1 in two boxes; three quarters of its middle half finer by `ratio`, in two
/// boxes; and an eighth of that half finer by it again. n is even.
inline io::amr::Hierarchy nested_boxes(std::int64_t n, std::int64_t ratio) {
    const auto spacing = [&](std::int64_t parts) {
        const double one = 1.0 / static_cast<double>(n * parts);
        return std::array<double, 3>{one, one, one};
    };
    const std::int64_t last = 2 * n - 1, low = ratio * (n / 2), half = ratio * n, high = ratio * (n / 2 + n) - 1;
    return {{-1, -1, -1},
            {{spacing(1), {{{0, 0, 0}, {last, last, n - 1}}, {{0, 0, n}, {last, last, last}}}},
             {spacing(ratio), {{{low, low, low}, {half - 1, high, high}}, {{half, low, low}, {high, half - 1, high}}}},
             {spacing(ratio * ratio),
              {{{ratio * low, ratio * low, ratio * low}, {ratio * half - 1, ratio * half - 1, ratio * half - 1}}}}}};
}

} // namespace isotet::test
