// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <atomic>
#include <optional>
#include <span>
#include <utility>

#include "base/buffer.hpp"
#include "base/parallel.hpp"
#include "io/foam/mesh.hpp"

namespace isotet::io::foam {

namespace {

constexpr std::size_t cells_per_task = 1 << 14;
constexpr std::uint8_t polyhedron = 42;

/// The faces of each cell; ~face where the cell is the neighbour, not the owner.
struct CellFaces {
    std::vector<std::uint64_t> begins;
    std::vector<std::int32_t> faces;

    explicit CellFaces(const Mesh& mesh) : begins(mesh.cells + 1, 0) {
        const auto each = [&](const auto& put) {
            for (std::size_t face = 0; face < mesh.owner.size(); ++face) {
                put(mesh.owner[face], face);
                if (mesh.neighbour[face] >= 0) put(mesh.neighbour[face], ~face);
            }
        };
        each([&](std::int32_t cell, std::size_t) { ++begins[static_cast<std::size_t>(cell) + 1]; });
        for (std::size_t cell = 0; cell < mesh.cells; ++cell) begins[cell + 1] += begins[cell];
        faces.resize(static_cast<std::size_t>(begins.back()));
        each([&](std::int32_t cell, std::size_t face) {
            faces[static_cast<std::size_t>(begins[static_cast<std::size_t>(cell)]++)] = static_cast<std::int32_t>(face);
        });
        for (std::size_t cell = mesh.cells; cell > 0; --cell) begins[cell] = begins[cell - 1];
        begins[0] = 0;
    }
    std::span<const std::int32_t> of(std::size_t cell) const {
        return {faces.data() + begins[cell], static_cast<std::size_t>(begins[cell + 1] - begins[cell])};
    }
};

/// A loop of three or four points.
struct ShortLoop {
    std::array<std::int32_t, 4> points{};
    std::size_t count = 0;

    bool operator==(const ShortLoop& other) const {
        const auto &a = points, &b = other.points; // by a call of memcmp() it takes a fifth of all the time of cells
        return ((a[0] ^ b[0]) | (a[1] ^ b[1]) | (a[2] ^ b[2]) | (a[3] ^ b[3])) == 0 && count == other.count;
    }
    bool has(std::int32_t point) const {
        unsigned same = count == 4 && point == points[3] ? 1 : 0;
        for (std::size_t k = 0; k < 3; ++k) same += point == points[k] ? 1 : 0;
        return same > 0;
    }
    void reverse() { std::reverse(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(count)); }
    /// The lowest point first.
    void rotate() {
        const auto end = points.begin() + static_cast<std::ptrdiff_t>(count);
        std::rotate(points.begin(), std::min_element(points.begin(), end), end);
    }
    /// The same for both windings: the lowest point, the lower one beside it, what is opposite, the other one beside it.
    ShortLoop unwound() const {
        if (count == 3) {
            const auto [low, high] = std::minmax({points[0], points[1], points[2]});
            return {{low, points[0] ^ points[1] ^ points[2] ^ low ^ high, high}, 3};
        }
        const std::size_t first = points[1] < points[0] ? 1 : 0, second = points[3] < points[2] ? 3 : 2,
                          low = points[second] < points[first] ? second : first;
        const auto [lower, higher] = std::minmax(points[(low + 1) % 4], points[(low + 3) % 4]);
        return {{points[low], lower, points[(low + 2) % 4], higher}, 4};
    }
};

struct CellShape {
    std::uint8_t type;
    std::size_t corners, base; ///< points of the base
    bool base_outward;         ///< the base's loop, by the right hand, points out of the cell
    std::size_t face_count;
    std::array<std::array<std::uint8_t, 4>, 6> faces; ///< a triangle ends in `none`

    static constexpr std::uint8_t none = 255;
};

constexpr std::uint8_t none = CellShape::none;
constexpr std::array<CellShape, 4> cell_shapes = {{
    {10, 4, 3, false, 4, {{{0, 1, 3, none}, {1, 2, 3, none}, {2, 0, 3, none}, {0, 2, 1, none}}}},
    {14, 5, 4, false, 5, {{{0, 3, 2, 1}, {0, 1, 4, none}, {1, 2, 4, none}, {2, 3, 4, none}, {3, 0, 4, none}}}},
    {13, 6, 3, true, 5, {{{0, 1, 2, none}, {3, 5, 4, none}, {0, 3, 4, 1}, {1, 4, 5, 2}, {2, 5, 3, 0}}}},
    {12, 8, 4, false, 6, {{{0, 4, 7, 3}, {1, 2, 6, 5}, {0, 1, 5, 4}, {3, 7, 6, 2}, {0, 3, 2, 1}, {4, 5, 6, 7}}}},
}};

/// What a cell becomes.
struct BuiltCell {
    std::uint8_t type = polyhedron;
    std::array<std::int32_t, 8> corners{};
};

class CellBuilder {
public:
    CellBuilder(const Mesh& mesh, const CellFaces& faces) : mesh_(mesh), faces_(faces) {}

    BuiltCell build(std::size_t cell) const {
        const auto faces = faces_.of(cell);
        const CellShape* shape = shape_of(faces);
        if (!shape) return {};
        std::array<ShortLoop, 6> loops, unwound; // outward; and canonical
        for (std::size_t i = 0; i < faces.size(); ++i) {
            loops[i] = outward(faces[i]);
            unwound[i] = loops[i].unwound();
        }
        BuiltCell built{shape->type, {}};
        const std::span all(loops.data(), faces.size());
        const std::span canonical(unwound.data(), faces.size());
        if (!place_corners(*shape, all, canonical, built.corners) || !has_faces(*shape, built.corners, canonical))
            return {};
        return built;
    }

    /// The points of all faces, each once.
    std::vector<std::int32_t> points_of(std::size_t cell) const {
        std::vector<std::int32_t> points;
        for (const std::int32_t face : faces_.of(cell)) {
            const auto loop = loop_of(face);
            points.insert(points.end(), loop.begin(), loop.end());
        }
        std::ranges::sort(points);
        const auto again = std::ranges::unique(points);
        points.erase(again.begin(), again.end());
        return points;
    }
    std::span<const std::int32_t> loop_of(std::int32_t face) const {
        return mesh_.faces.of(static_cast<std::size_t>(face < 0 ? ~face : face));
    }
    std::span<const std::int32_t> faces_of(std::size_t cell) const { return faces_.of(cell); }

private:
    const CellShape* shape_of(std::span<const std::int32_t> faces) const {
        if (faces.size() < 4 || faces.size() > 6) return nullptr;
        std::size_t triangles = 0;
        for (const std::int32_t face : faces) {
            const std::size_t points = loop_of(face).size();
            if (points != 3 && points != 4) return nullptr;
            triangles += points == 3;
        }
        if (faces.size() == 4) return triangles == 4 ? &cell_shapes[0] : nullptr;
        if (faces.size() == 5) return triangles == 4 ? &cell_shapes[1] : triangles == 2 ? &cell_shapes[2] : nullptr;
        return triangles == 0 ? &cell_shapes[3] : nullptr;
    }

    ShortLoop outward(std::int32_t face) const {
        ShortLoop loop;
        for (const std::int32_t point : loop_of(face)) loop.points[loop.count++] = point;
        if (face < 0) loop.reverse();
        return loop;
    }

    /// Corners of the lowest base, then the one above each: a neighbour in a side face that is not in the base.
    static bool place_corners(const CellShape& shape, std::span<const ShortLoop> loops,
                              std::span<const ShortLoop> unwound, std::array<std::int32_t, 8>& corners) {
        const ShortLoop *base = nullptr, *lowest = nullptr;
        for (std::size_t i = 0; i < loops.size(); ++i)
            if (loops[i].count == shape.base && (!lowest || unwound[i].points < lowest->points)) {
                base = &loops[i];
                lowest = &unwound[i];
            }
        if (!base) return false;
        ShortLoop bottom = *base;
        if (!shape.base_outward) bottom.reverse();
        bottom.rotate();
        std::copy_n(bottom.points.begin(), shape.base, corners.begin());
        for (const ShortLoop& loop : loops) {
            std::array<bool, 4> is_below{};
            for (std::size_t k = 0; k < loop.count; ++k) is_below[k] = bottom.has(loop.points[k]);
            for (std::size_t k = 0; k < loop.count; ++k) {
                const std::size_t after = k + 1 == loop.count ? 0 : k + 1;
                if (!is_below[k] || is_below[after]) continue;
                const std::int32_t point = loop.points[k], next = loop.points[after];
                if (shape.corners == shape.base + 1) corners[shape.base] = next;
                for (std::size_t i = 0; i < shape.base && shape.corners > shape.base + 1; ++i)
                    if (bottom.points[i] == point) corners[shape.base + i] = next;
            }
        }
        return true;
    }

    static bool has_faces(const CellShape& shape, const std::array<std::int32_t, 8>& corners,
                          std::span<const ShortLoop> unwound) {
        for (std::size_t i = 0; i < shape.corners; ++i)
            for (std::size_t k = 0; k < i; ++k)
                if (corners[i] == corners[k]) return false;
        for (std::size_t i = 0; i < shape.face_count; ++i) {
            ShortLoop loop;
            for (const std::uint8_t corner : shape.faces[i])
                if (corner != none) loop.points[loop.count++] = corners[corner];
            if (std::ranges::find(unwound, loop.unwound()) == unwound.end()) return false;
        }
        return true;
    }

    const Mesh& mesh_;
    const CellFaces& faces_;
};

std::size_t corner_count(std::uint8_t type) {
    for (const CellShape& shape : cell_shapes)
        if (shape.type == type) return shape.corners;
    return 0;
}

/// Begins from counts.
std::vector<std::int64_t> sums_of(const std::vector<std::int64_t>& counts) {
    std::vector<std::int64_t> sums(counts.size() + 1, 0);
    for (std::size_t i = 0; i < counts.size(); ++i) sums[i + 1] = sums[i] + counts[i];
    return sums;
}

/// The cells, where all are of one kind: most meshes are, and need no memory beside the corners. Else nothing, after a look
/// at a few cells in most cases.
std::optional<Cells> cells_of_one_kind(const Mesh& mesh, const CellBuilder& builder) {
    constexpr std::size_t looked_at = 64;
    if (mesh.cells == 0) return std::nullopt;
    const std::uint8_t type = builder.build(0).type;
    const auto is_other = [&](std::size_t cell) { return builder.build(cell).type != type; };
    if (type == polyhedron) return std::nullopt;
    for (std::size_t i = 1; i <= looked_at; ++i)
        if (is_other((mesh.cells - 1) / looked_at * i)) return std::nullopt;
    const std::size_t corners = corner_count(type);
    core::Buffer<std::int32_t> connectivity(corners * mesh.cells);
    std::atomic<bool> are_alike = true;
    core::parallel_each(mesh.cells, cells_per_task, [&](std::size_t cell) {
        if (!are_alike.load(std::memory_order_relaxed)) return;
        const BuiltCell built = builder.build(cell);
        if (built.type != type) are_alike = false;
        std::copy_n(built.corners.begin(), corners, connectivity.data() + corners * cell);
    });
    if (!are_alike) return std::nullopt;
    Cells cells;
    cells.connectivity = std::move(connectivity).to_array();
    cells.uniform_type = static_cast<CellType>(type);
    return cells;
}

} // namespace

Cells cells_of(Mesh& mesh) {
    const CellFaces faces(mesh);
    mesh.owner = std::vector<std::int32_t>();
    mesh.neighbour = std::vector<std::int32_t>(); // {} would keep the memory
    const CellBuilder builder(mesh, faces);
    if (auto cells = cells_of_one_kind(mesh, builder)) return *std::move(cells);
    std::vector<std::uint8_t> types(mesh.cells);
    std::vector<std::int64_t> corners(mesh.cells), stream(mesh.cells);
    std::vector<std::array<std::int32_t, 8>> built(mesh.cells);
    core::parallel_each(mesh.cells, cells_per_task, [&](std::size_t cell) {
        const BuiltCell known = builder.build(cell);
        types[cell] = known.type;
        built[cell] = known.corners;
        corners[cell] = static_cast<std::int64_t>(corner_count(types[cell]));
        if (types[cell] != polyhedron) return;
        corners[cell] = static_cast<std::int64_t>(builder.points_of(cell).size());
        stream[cell] = 1;
        for (const std::int32_t face : builder.faces_of(cell))
            stream[cell] += static_cast<std::int64_t>(1 + builder.loop_of(face).size());
    });
    std::vector<std::int64_t> offsets = sums_of(corners), face_offsets = sums_of(stream);
    corners = std::vector<std::int64_t>();
    stream = std::vector<std::int64_t>();
    std::vector<std::int32_t> connectivity(static_cast<std::size_t>(offsets.back()));
    std::vector<std::int32_t> face_stream(static_cast<std::size_t>(face_offsets.back()));
    core::parallel_each(mesh.cells, cells_per_task, [&](std::size_t cell) {
        std::int32_t* to = connectivity.data() + offsets[cell];
        if (types[cell] != polyhedron) {
            std::copy_n(built[cell].begin(), corner_count(types[cell]), to);
            return;
        }
        std::ranges::copy(builder.points_of(cell), to);
        std::int32_t* next = face_stream.data() + face_offsets[cell];
        *next++ = static_cast<std::int32_t>(builder.faces_of(cell).size());
        for (const std::int32_t face : builder.faces_of(cell)) {
            const auto loop = builder.loop_of(face);
            *next++ = static_cast<std::int32_t>(loop.size());
            next = std::ranges::copy(loop, next).out;
        }
    });
    Cells cells;
    cells.connectivity = Array::own(std::move(connectivity));
    if (!face_stream.empty()) {
        cells.faces = Array::own(std::move(face_stream));
        cells.face_offsets = Array::own(std::move(face_offsets));
    }
    cells.offsets = Array::own(std::move(offsets));
    cells.types = Array::own(std::move(types));
    return cells;
}

} // namespace isotet::io::foam
