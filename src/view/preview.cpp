// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "view/mesh.hpp"

namespace isotet::view {

namespace {

/// Cells of a lattice, numbered in the order in which they are met.
class CellNumbers {
public:
    explicit CellNumbers(std::size_t most) {
        while (size_ < 2 * most) size_ *= 2;
        cells_.assign(size_, no_cell);
        numbers_.resize(size_);
    }

    std::uint32_t number_of(std::uint64_t cell) {
        std::size_t at = (cell * 0x9E3779B97F4A7C15U >> 20) & (size_ - 1);
        while (cells_[at] != no_cell && cells_[at] != cell) at = (at + 1) & (size_ - 1);
        if (cells_[at] == no_cell) {
            cells_[at] = cell;
            numbers_[at] = count_++;
        }
        return numbers_[at];
    }
    std::uint32_t count() const noexcept { return count_; }

private:
    static constexpr std::uint64_t no_cell = UINT64_MAX;
    std::size_t size_ = 1024;
    std::vector<std::uint64_t> cells_;
    std::vector<std::uint32_t> numbers_;
    std::uint32_t count_ = 0;
};

/// Cubes of one size, `along` of them along the longest edge of the box.
struct Lattice {
    std::array<std::uint64_t, 3> along{1, 1, 1};

    Lattice(const Box& box, double longest) {
        double edge = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) edge = std::max(edge, box.upper[axis] - box.lower[axis]);
        for (std::size_t axis = 0; axis < 3; ++axis)
            along[axis] = static_cast<std::uint64_t>(
                std::clamp(std::ceil(longest * (box.upper[axis] - box.lower[axis]) / edge), 1.0, 65536.0));
    }
    std::uint64_t cell_of(const MeshVertex& vertex) const {
        std::uint64_t cell = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) cell = cell << 17 | (vertex.place[axis] * along[axis]) >> 16;
        return cell;
    }
};

/// How many cells along the longest edge hold about `vertices` vertices: the number grows with its square. Guessed from a
/// coarse lattice.
double cells_along(const Mesh& mesh, double vertices) {
    constexpr double coarse = 64;
    const Lattice lattice(mesh.box, coarse);
    CellNumbers numbers(std::min<std::size_t>(mesh.vertices.size(), std::size_t{1} << 18));
    const std::size_t step = std::max<std::size_t>(1, mesh.vertices.size() >> 18);
    for (std::size_t i = 0; i < mesh.vertices.size(); i += step) numbers.number_of(lattice.cell_of(mesh.vertices[i]));
    return coarse * std::sqrt(vertices / std::max(1U, numbers.count()));
}

/// What the vertices of one cell have in common.
struct Gathered {
    std::array<std::uint64_t, 3> sum{};
    std::uint32_t count = 0, first = 0;
};

} // namespace

SurfacePoints some_points_of(const Mesh& mesh) {
    constexpr std::size_t most = 2048, places = 65535;
    SurfacePoints points;
    const std::size_t step = (mesh.vertices.size() + most - 1) / most;
    for (std::size_t i = 0; i < mesh.vertices.size(); i += step) {
        std::array<double, 3>& point = points.emplace_back();
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double part = static_cast<double>(mesh.vertices[i].place[axis]) / places;
            point[axis] = mesh.box.lower[axis] + part * (mesh.box.upper[axis] - mesh.box.lower[axis]);
        }
    }
    return points;
}

Mesh preview_of(const Mesh& mesh, std::size_t triangles) {
    if (mesh.flat || mesh.triangle_count() <= triangles || mesh.box.empty()) return mesh;
    const Lattice lattice(mesh.box, cells_along(mesh, static_cast<double>(triangles) / 2));
    CellNumbers numbers(mesh.vertices.size());
    std::vector<std::uint32_t> number_of(mesh.vertices.size());
    std::vector<Gathered> cells;
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
        number_of[i] = numbers.number_of(lattice.cell_of(mesh.vertices[i]));
        if (number_of[i] == cells.size()) cells.push_back({{}, 0, static_cast<std::uint32_t>(i)});
        Gathered& cell = cells[number_of[i]];
        for (std::size_t axis = 0; axis < 3; ++axis) cell.sum[axis] += mesh.vertices[i].place[axis];
        ++cell.count;
    }
    Mesh preview;
    preview.box = mesh.box;
    preview.vertices.resize(cells.size());
    for (std::size_t i = 0; i < cells.size(); ++i) {
        for (std::size_t axis = 0; axis < 3; ++axis)
            preview.vertices[i].place[axis] = static_cast<std::uint16_t>(cells[i].sum[axis] / cells[i].count);
        preview.vertices[i].normal = mesh.vertices[cells[i].first].normal;
        if (!mesh.colors.empty()) preview.colors.push_back(mesh.colors[cells[i].first]);
    }
    for (std::size_t i = 0; i < mesh.corners.size(); i += 3) {
        const std::uint32_t a = number_of[mesh.corners[i]], b = number_of[mesh.corners[i + 1]],
                            c = number_of[mesh.corners[i + 2]];
        if (a != b && b != c && c != a) preview.corners.insert(preview.corners.end(), {a, b, c});
    }
    return preview;
}

} // namespace isotet::view
