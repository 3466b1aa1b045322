// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include <fmt/core.h>

#include "io/foam/mesh.hpp"
#include "io/pieces/join/point_numbers.hpp"
#include "io/pieces/join/seams.hpp"

namespace isotet::io::foam {

namespace {

using Numbers = std::vector<std::vector<std::int32_t>>;

/// A list of labels beside the faces of each part; nothing where a part has none.
Result<std::optional<Numbers>> addressing(const CaseFiles& files, const std::vector<MeshPlace>& places,
                                          const char* name) {
    Numbers numbers;
    for (const MeshPlace& place : places) {
        const std::string file = place.faces + "/" + name;
        if (!files.has(file)) return std::optional<Numbers>();
        auto text = files.open(file);
        if (!text) return text.error();
        Scanner scanner(std::move(*text));
        if (auto header = scanner.header(); !header) return header.error();
        auto labels = scanner.labels("the numbers in the whole case", 0);
        if (!labels) return labels.error();
        numbers.push_back(std::move(*labels));
    }
    return std::optional(std::move(numbers));
}

Array points_of(const Mesh& mesh) { return {ScalarType::float64, mesh.points.data(), mesh.point_count(), 3, nullptr}; }

/// How far apart the places of one point may be: of a mesh that moves each processor rounds them by itself.
double closeness(const std::vector<Mesh>& meshes) {
    Box whole;
    for (const Mesh& mesh : meshes) whole.add(box_of(points_of(mesh), {}));
    double length = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) length = std::max(length, whole.upper[axis] - whole.lower[axis]);
    return 1e-6 * length;
}

/// How many points the numbers count, where they are the numbers of a whole grid: all of them used, at one place each.
std::optional<std::size_t> points_counted(const Numbers& numbers, const std::vector<Mesh>& meshes) {
    std::size_t most = 0;
    for (std::size_t p = 0; p < meshes.size(); ++p) {
        if (numbers[p].size() != meshes[p].point_count()) return std::nullopt;
        most += numbers[p].size();
    }
    std::vector<double> places(3 * most, 0);
    std::vector<bool> used(most);
    const double tolerance = closeness(meshes);
    const auto is_close = [&](double a, double b) { return std::abs(a - b) <= tolerance; };
    std::size_t different = 0, end = 0;
    for (std::size_t p = 0; p < meshes.size(); ++p)
        for (std::size_t i = 0; i < numbers[p].size(); ++i) {
            if (numbers[p][i] < 0 || static_cast<std::size_t>(numbers[p][i]) >= most) return std::nullopt;
            const auto number = static_cast<std::size_t>(numbers[p][i]);
            const double* place = meshes[p].points.data() + 3 * i;
            double* const known = places.data() + 3 * number;
            if (used[number] && !std::equal(place, place + 3, known, is_close)) return std::nullopt;
            std::copy_n(place, 3, known);
            different += !used[number];
            used[number] = true;
            end = std::max(end, number + 1);
        }
    return end == different ? std::optional(end) : std::nullopt;
}

bool is_permutation_of_cells(const Numbers& numbers, const std::vector<Mesh>& meshes) {
    std::size_t cells = 0;
    for (std::size_t p = 0; p < meshes.size(); ++p) {
        if (numbers[p].size() != meshes[p].cells) return false;
        cells += meshes[p].cells;
    }
    std::vector<bool> used(cells);
    for (const auto& of_part : numbers)
        for (const std::int32_t number : of_part) {
            if (number < 0 || static_cast<std::size_t>(number) >= cells || used[static_cast<std::size_t>(number)])
                return false;
            used[static_cast<std::size_t>(number)] = true;
        }
    return true;
}

/// Numbers by equal coordinates, or one part after another, and how many points that makes.
Result<std::pair<Numbers, std::size_t>> own_numbers(const std::vector<Mesh>& meshes, bool by_coordinates) {
    std::vector<SeamPiece> pieces;
    std::vector<std::uint64_t> counts;
    for (const Mesh& mesh : meshes) {
        pieces.push_back({points_of(mesh), {}, {}, box_of(points_of(mesh), {})});
        counts.push_back(mesh.point_count());
    }
    Seams seams;
    if (by_coordinates) {
        auto found = find_seams(pieces, {});
        if (!found) return found.error();
        seams = *std::move(found);
    }
    const PointNumbers found = PointNumbers::make(counts, {}, seams.joined);
    Numbers numbers(meshes.size());
    for (std::size_t p = 0; p < meshes.size(); ++p)
        for (std::size_t i = 0; i < meshes[p].point_count(); ++i)
            numbers[p].push_back(static_cast<std::int32_t>(found.pieces[p](i)));
    return std::pair(std::move(numbers), static_cast<std::size_t>(found.count));
}

void append_mesh(Mesh from, Part& part, Mesh& whole) {
    const auto point = [&](std::int32_t own) { return part.point_numbers[static_cast<std::size_t>(own)]; };
    const auto cell = [&](std::int32_t own) {
        return own < 0 ? own : part.cell_numbers[static_cast<std::size_t>(own)];
    };
    const std::size_t first_face = whole.faces.count(), first_corner = whole.faces.points.size();
    for (std::size_t i = 0; i < from.point_count(); ++i)
        std::copy_n(from.points.data() + 3 * i, 3,
                    whole.points.data() + 3 * static_cast<std::size_t>(part.point_numbers[i]));
    for (std::size_t face = 0; face < from.faces.count(); ++face) {
        whole.faces.begins.push_back(first_corner + from.faces.begin(face + 1));
        whole.owner.push_back(cell(from.owner[face]));
        whole.neighbour.push_back(cell(from.neighbour[face]));
    }
    for (const std::int32_t corner : from.faces.points) whole.faces.points.push_back(point(corner));
    for (Patch& patch : from.patches) patch.first += first_face;
    part.patches = std::move(from.patches);
    whole.single = whole.single && from.single;
}

} // namespace

Result<WholeMesh> join_meshes(const CaseFiles& files, std::vector<Mesh> meshes, const std::vector<MeshPlace>& places,
                              const std::vector<std::string>& prefixes, bool by_coordinates) {
    WholeMesh out;
    for (std::size_t p = 0; p < meshes.size(); ++p)
        out.parts.push_back({prefixes[p], {}, meshes[p].point_count(), meshes[p].cells, {}, {}});
    if (meshes.size() == 1) {
        out.parts[0].patches = meshes[0].patches;
        out.mesh = std::move(meshes[0]);
        return out;
    }
    std::size_t points = 0, cells = 0;
    for (const Mesh& mesh : meshes) {
        points += mesh.point_count();
        cells += mesh.cells;
    }
    if (std::max(points, cells) > std::numeric_limits<std::int32_t>::max())
        return Error{ErrorCode::invalid_data,
                     fmt::format("{}: {} points and {} cells in all parts, but below 2^31 are read", files.path_of(""),
                                 points, cells)};
    auto point_numbers = addressing(files, places, "pointProcAddressing");
    if (!point_numbers) return point_numbers.error();
    auto cell_numbers = addressing(files, places, "cellProcAddressing");
    if (!cell_numbers) return cell_numbers.error();
    const auto counted = *point_numbers ? points_counted(**point_numbers, meshes) : std::nullopt;
    if (!counted) {
        auto own = own_numbers(meshes, by_coordinates);
        if (!own) return own.error();
        auto& [numbers, count] = *own;
        out.notes.push_back(fmt::format("{} processor folders {} pointProcAddressing{}: {} points were {}",
                                        meshes.size(), *point_numbers ? "have no sound" : "have no", "", points - count,
                                        by_coordinates ? "merged by equal coordinates" : "merged (--keep-pieces)"));
        *point_numbers = std::move(numbers);
        points = count;
    } else {
        out.notes.push_back(fmt::format("{} processor folders joined by global point numbers: {} points were merged",
                                        meshes.size(), points - *counted));
        points = *counted;
    }
    const bool cells_numbered = *cell_numbers && is_permutation_of_cells(**cell_numbers, meshes);
    out.mesh.points.resize(3 * points);
    out.mesh.cells = cells;
    out.mesh.single = true;
    std::int32_t next_cell = 0;
    for (std::size_t p = 0; p < meshes.size(); ++p) {
        Part& part = out.parts[p];
        part.point_numbers = std::move((**point_numbers)[p]);
        if (cells_numbered) part.cell_numbers = std::move((**cell_numbers)[p]);
        else
            for (std::size_t cell = 0; cell < part.cells; ++cell) part.cell_numbers.push_back(next_cell++);
        append_mesh(std::move(meshes[p]), part, out.mesh);
        meshes[p] = Mesh();
    }
    out.mesh.faces.drop_regular_begins();
    return out;
}

} // namespace isotet::io::foam
