// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/vtk/cgns_faces.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <optional>
#include <utility>

#include <fmt/core.h>

#include "core/cell_faces.hpp"
#include "core/errors.hpp"
#include "io/own/escape.hpp"
#include "io/own/loaded.hpp"
#include "io/own/shared_faces.hpp"
#include "io/vtk/cgns_tree.hpp"

namespace isotet::io::vtk {
namespace {

using Numbers = std::vector<std::int64_t>;

constexpr std::int64_t ngon = 22, nface = 23; ///< of ElementType_t

/// Elements_t of one of both kinds.
struct FaceSection {
    std::int64_t first = 0, last = 0; ///< numbers of its elements in the zone
    Numbers offsets, values;          ///< points of faces, or faces of cells, as the file counts them
    Numbers parents; ///< of faces: a cell on each side, 0 where there is none; those of the left sides first

    std::size_t count() const { return offsets.size() - 1; }
};

/// A zone while it is read. Errors begin without its name.
class ZoneReader {
public:
    ZoneReader(const CgnsTree& tree, const CgnsNode& zone) : tree_(tree), zone_(zone) {}

    /// False: it has no faces.
    Result<bool> read();
    Result<void> check() const;
    Result<Cells> cells_of_parents() const;
    bool has_cells() const { return !cells_.empty(); }
    bool has_parents() const {
        return std::ranges::any_of(faces_, [](const FaceSection& s) { return !s.parents.empty(); });
    }

private:
    Result<Numbers> numbers(const std::vector<CgnsNode>& nodes, const char* name) const;
    Result<std::optional<FaceSection>> read_section(const CgnsNode& node, std::int64_t kind) const;
    static Result<void> take_counts_out(FaceSection& section);
    SharedFaces shared_faces() const;
    std::int64_t index_of_face(std::int64_t number) const;
    Result<Numbers> parents() const;

    const CgnsTree& tree_;
    const CgnsNode& zone_;
    std::int64_t points_ = 0;
    std::vector<FaceSection> faces_, cells_; ///< ascending
};

bool has_child(const std::vector<CgnsNode>& nodes, std::string_view name) {
    return std::ranges::find(nodes, name, &CgnsNode::name) != nodes.end();
}

/// Empty where the node is not there.
Result<Numbers> ZoneReader::numbers(const std::vector<CgnsNode>& nodes, const char* name) const {
    const auto node = std::ranges::find(nodes, name, &CgnsNode::name);
    if (node == nodes.end()) return Numbers();
    const auto array = tree_.integers(*node);
    if (!array) return array.error();
    return array->visit([](auto values) { return Numbers(values.begin(), values.end()); });
}

/// Before CGNS 3.4 the number of points or faces stands before each element's.
Result<void> ZoneReader::take_counts_out(FaceSection& section) {
    Numbers values, offsets{0};
    for (std::size_t at = 0; at < section.values.size();) {
        const std::int64_t count = section.values[at++];
        if (count < 0 || static_cast<std::uint64_t>(count) > section.values.size() - at)
            return invalid_data(fmt::format("element {} has {} points or faces, but {} numbers are left",
                                            section.first + static_cast<std::int64_t>(offsets.size()) - 1, count,
                                            section.values.size() - at));
        const auto from = section.values.begin() + static_cast<std::ptrdiff_t>(at);
        values.insert(values.end(), from, from + count);
        offsets.push_back(static_cast<std::int64_t>(values.size()));
        at += static_cast<std::size_t>(count);
    }
    section.values = std::move(values);
    section.offsets = std::move(offsets);
    return {};
}

/// Nothing where the section is of another kind.
Result<std::optional<FaceSection>> ZoneReader::read_section(const CgnsNode& node, std::int64_t kind) const {
    const auto type = tree_.integers(node);
    if (!type) return type.error();
    if (type->size() < 1 || type->at(0) != static_cast<double>(kind)) return std::optional<FaceSection>();
    const std::vector<CgnsNode> nodes = tree_.children(node);
    const auto range = numbers(nodes, "ElementRange");
    if (!range) return range.error();
    const auto wrong = [&](const std::string& what) {
        return invalid_data(fmt::format("section \"{}\" {}", escaped(node.name), what));
    };
    if (range->size() != 2 || (*range)[0] < 1 || (*range)[1] < (*range)[0])
        return wrong("has no range of elements, from 1 on");
    auto values = numbers(nodes, "ElementConnectivity");
    if (!values) return values.error();
    auto offsets = numbers(nodes, "ElementStartOffset");
    if (!offsets) return offsets.error();
    FaceSection section{(*range)[0], (*range)[1], *std::move(offsets), *std::move(values), {}};
    if (!has_child(nodes, "ElementStartOffset"))
        if (auto taken = take_counts_out(section); !taken) return wrong(taken.error().message);
    const auto elements = static_cast<std::uint64_t>(section.last - section.first) + 1;
    if (section.offsets.size() != elements + 1)
        return wrong(fmt::format("has {} offsets for the elements {} to {}, but must have one more than elements",
                                 section.offsets.size(), section.first, section.last));
    auto parents = numbers(nodes, "ParentElements");
    if (!parents) return parents.error();
    section.parents = *std::move(parents);
    if (!section.parents.empty() && section.parents.size() != 2 * elements)
        return wrong(
            fmt::format("has {} parents of {} faces, but must have two of each", section.parents.size(), elements));
    return std::optional(std::move(section));
}

Result<bool> ZoneReader::read() {
    const auto size = tree_.integers(zone_);
    if (!size) return false; // VTK's reader tells
    points_ = size->empty() ? 0 : static_cast<std::int64_t>(size->at(0));
    for (const CgnsNode& node : tree_.children(zone_)) {
        if (node.label != "Elements_t") continue;
        for (const auto& [kind, sections] : {std::pair(ngon, &faces_), std::pair(nface, &cells_)}) {
            auto section = read_section(node, kind);
            if (!section) return section.error();
            if (*section) sections->push_back(**std::move(section));
        }
    }
    for (auto* sections : {&faces_, &cells_}) {
        std::ranges::sort(*sections, {}, &FaceSection::first);
        for (std::size_t i = 1; i < sections->size(); ++i)
            if ((*sections)[i].first <= (*sections)[i - 1].last)
                return invalid_data(fmt::format("two sections have element {}", (*sections)[i].first));
    }
    return !faces_.empty();
}

/// -1: there is no such face.
std::int64_t ZoneReader::index_of_face(std::int64_t number) const {
    std::int64_t before = 0;
    for (const FaceSection& section : faces_) {
        if (number >= section.first && number <= section.last) return before + number - section.first;
        before += static_cast<std::int64_t>(section.count());
    }
    return -1;
}

/// Sections one after another, all numbers from 0; signs are dropped.
SharedFaces ZoneReader::shared_faces() const {
    Numbers points, face_offsets{0}, faces, cell_offsets{0};
    const auto append_offsets = [](const FaceSection& section, std::size_t before, Numbers& to) {
        for (std::size_t i = 1; i < section.offsets.size(); ++i)
            to.push_back(static_cast<std::int64_t>(before) + section.offsets[i]);
        if (section.offsets.front() != 0)
            to[to.size() - section.count() - 1] = section.offsets.front(); // is found wrong
    };
    for (const FaceSection& section : faces_) {
        append_offsets(section, points.size(), face_offsets);
        for (const std::int64_t point : section.values) points.push_back(point - 1);
    }
    for (const FaceSection& section : cells_) {
        append_offsets(section, faces.size(), cell_offsets);
        for (const std::int64_t face : section.values)
            faces.push_back(index_of_face(face < 0 ? -(face + 1) + 1 : face));
    }
    return {Array::own(std::move(points)), Array::own(std::move(face_offsets)), Array::own(std::move(faces)),
            Array::own(std::move(cell_offsets))};
}

Result<void> ZoneReader::check() const {
    for (const auto* sections : {&faces_, &cells_})
        for (const FaceSection& section : *sections)
            if (section.offsets.front() != 0 ||
                section.offsets.back() != static_cast<std::int64_t>(section.values.size()))
                return invalid_data(fmt::format("the elements {} to {} have the offsets {} to {}, but {} numbers",
                                                section.first, section.last, section.offsets.front(),
                                                section.offsets.back(), section.values.size()));
    for (const FaceSection& section : faces_)
        for (const std::int64_t point : section.values)
            if (point < 1 || point > points_)
                return invalid_data(fmt::format("a face has point {}, but the points are 1 to {}", point, points_));
    for (const FaceSection& section : cells_)
        for (const std::int64_t face : section.values)
            if (face == std::numeric_limits<std::int64_t>::min() || index_of_face(std::abs(face)) < 0)
                return invalid_data(fmt::format("a cell has face {}, which is in no section of faces", face));
    return check_shared_faces(shared_faces());
}

/// Cells from 0, those of the left sides and then those of the right ones; -1 where there is none.
Result<Numbers> ZoneReader::parents() const {
    Numbers all;
    for (const std::size_t side : {0, 1})
        for (const FaceSection& section : faces_) {
            if (section.parents.empty())
                return invalid_data(fmt::format("the faces {} to {} have no cells", section.first, section.last));
            const auto from = section.parents.begin() + static_cast<std::ptrdiff_t>(side * section.count());
            all.insert(all.end(), from, from + static_cast<std::ptrdiff_t>(section.count()));
        }
    std::int64_t lowest = std::numeric_limits<std::int64_t>::max(), last_face = faces_.back().last;
    for (const std::int64_t cell : all)
        if (cell != 0) lowest = std::min(lowest, cell);
    const std::int64_t first = lowest > last_face ? last_face + 1 : 1; // behind the faces, or numbers of their own
    for (std::int64_t& cell : all) {
        if (cell < 0 || cell - first > std::int64_t{1} << 48)
            return invalid_data(fmt::format("a face has cell {}, but cells are from {} on", cell, first));
        cell = cell == 0 ? -1 : cell - first;
    }
    return all;
}

Result<Cells> ZoneReader::cells_of_parents() const {
    const auto sides = parents();
    if (!sides) return sides.error();
    const std::size_t count = sides->size() / 2;
    const std::int64_t most = *std::ranges::max_element(*sides);
    if (most >= static_cast<std::int64_t>(sides->size()))
        return invalid_data(fmt::format("there are {} cells, but {} faces only", most + 1, count));
    Numbers offsets(static_cast<std::size_t>(most) + 2, 0), faces(sides->size());
    for (const std::int64_t cell : *sides)
        if (cell >= 0) ++offsets[static_cast<std::size_t>(cell) + 1];
    for (std::size_t i = 1; i < offsets.size(); ++i) offsets[i] += offsets[i - 1];
    faces.resize(static_cast<std::size_t>(offsets.back()));
    Numbers next = offsets;
    for (std::size_t i = 0; i < sides->size(); ++i)
        if (const std::int64_t cell = (*sides)[i]; cell >= 0)
            faces[static_cast<std::size_t>(next[static_cast<std::size_t>(cell)]++)] =
                static_cast<std::int64_t>(i % count);
    SharedFaces shared = shared_faces();
    shared.faces = Array::own(std::move(faces));
    shared.cell_offsets = Array::own(std::move(offsets));
    Cells cells;
    cells.types = Array::own(std::vector<std::uint8_t>(static_cast<std::size_t>(most) + 1, core::polyhedron_type));
    cells.offsets = Array::own(Numbers(static_cast<std::size_t>(most) + 2, 0));
    cells.connectivity = Array::own(Numbers());
    if (auto done = write_out_faces(shared, cells); !done) return done.error();
    if (auto done = list_points_of_faces(static_cast<std::uint64_t>(points_), cells); !done) return done.error();
    return cells;
}

/// Points and cells of a zone; 0 where it does not say.
struct ZoneSize {
    std::uint64_t points = 0, cells = 0;
};

/// Its values are the counts of points along each axis, then those of cells, then those of boundary points.
ZoneSize size_of_zone(const CgnsTree& tree, const CgnsNode& zone) {
    constexpr double most = 0x1p48;
    const auto counts = tree.integers(zone);
    if (!counts || counts->empty() || counts->size() % 3 != 0) return {};
    const std::size_t directions = counts->size() / 3;
    double points = 1, cells = 1;
    for (std::size_t k = 0; k < directions; ++k) {
        points *= counts->at(k);
        cells *= counts->at(directions + k);
    }
    const auto plausible = [&](double count) {
        return count > 0 && count < most ? static_cast<std::uint64_t>(count) : 0;
    };
    return {plausible(points), plausible(cells)};
}

/// How many values arrays of a group have at least; 0 where it is not of all points or cells.
std::uint64_t least_values(const CgnsTree& tree, const CgnsNode& group, const ZoneSize& size) {
    std::uint64_t least = size.points;
    for (const CgnsNode& node : tree.children(group)) {
        if (node.name == "PointList" || node.name == "PointRange") return 0;
        if (node.label != "GridLocation_t") continue;
        const std::string location = tree.text(node);
        if (location != "Vertex") least = location == "CellCenter" ? size.cells : 0;
    }
    return least;
}

/// By ElementType_t; 0 where elements differ, or are none of those.
constexpr std::array<std::uint8_t, 40> nodes_by_type{0,  0,  1,  2,  3,  3,  6,  4,  8,  9,  4,  10, 5,  14,
                                                     6,  15, 18, 8,  20, 27, 0,  13, 0,  0,  4,  9,  10, 12,
                                                     16, 16, 20, 21, 29, 30, 24, 38, 40, 32, 56, 64};

/// Elements of one type have the nodes that their range needs.
Result<void> check_elements(const CgnsTree& tree, const CgnsNode& section) {
    const auto type = tree.integers(section);
    if (!type || type->empty() || type->at(0) < 0 || type->at(0) >= double{nodes_by_type.size()}) return {};
    const std::uint64_t nodes = nodes_by_type[static_cast<std::size_t>(type->at(0))];
    if (nodes == 0) return {};
    const std::vector<CgnsNode> parts = tree.children(section);
    const auto range = std::ranges::find(parts, "ElementRange", &CgnsNode::name),
               connectivity = std::ranges::find(parts, "ElementConnectivity", &CgnsNode::name);
    if (range == parts.end() || connectivity == parts.end()) return {};
    if (auto sound = tree.check_values(*range, 2); !sound) return sound;
    const auto ends = tree.integers(*range);
    if (!ends) return ends.error();
    const double count = ends->at(1) - ends->at(0) + 1;
    constexpr double most = 0x1p48;
    if (!(count >= 0 && count < most)) return {};
    return tree.check_values(*connectivity, nodes * static_cast<std::uint64_t>(count));
}

/// VTK's reader leaves memory as it was where values cannot be read, and takes what lies behind arrays that are too short.
Result<void> check_arrays(const CgnsTree& tree, const CgnsNode& zone) {
    const ZoneSize size = size_of_zone(tree, zone);
    for (const CgnsNode& group : tree.children(zone)) {
        if (group.label == "Elements_t")
            if (auto sound = check_elements(tree, group); !sound) return sound;
        if (group.label != "FlowSolution_t" && group.label != "GridCoordinates_t") continue;
        const std::uint64_t least = least_values(tree, group, size);
        for (const CgnsNode& node : tree.children(group))
            if (node.label == "DataArray_t")
                if (auto sound = tree.check_values(node, least); !sound) return sound;
    }
    return {};
}

bool is_on_cells(const CgnsTree& tree, const CgnsNode& solution) {
    return std::ranges::any_of(tree.children(solution), [&](const CgnsNode& node) {
        return node.label == "GridLocation_t" && tree.text(node) == "CellCenter";
    });
}

} // namespace

Result<std::vector<CgnsFaceZone>> check_cgns_faces(const std::string& path) {
    const auto tree = CgnsTree::open(path);
    if (!tree) return tree.error();
    std::vector<CgnsFaceZone> found;
    for (const CgnsNode& base : tree->children(tree->root())) {
        if (base.label != "CGNSBase_t") continue;
        for (const CgnsNode& zone : tree->children(base)) {
            if (zone.label != "Zone_t") continue;
            const std::string name = base.name + "/" + zone.name;
            const auto wrong = [&](const Error& error) {
                return broken(path, fmt::format("zone \"{}\": {}", escaped(name), error.message));
            };
            if (auto sound = check_arrays(*tree, zone); !sound) return sound.error();
            ZoneReader reader(*tree, zone);
            const auto has_faces = reader.read();
            if (!has_faces) return wrong(has_faces.error());
            if (!*has_faces) continue;
            if (auto sound = reader.check(); !sound) return wrong(sound.error());
            found.push_back({name, {}});
            if (reader.has_cells() || !reader.has_parents()) continue;
            auto cells = reader.cells_of_parents();
            if (!cells) return wrong(cells.error());
            found.back().cells = *std::move(cells);
        }
    }
    return found;
}

Result<std::vector<Field>> cgns_cell_fields(const std::string& path, const std::string& zone, std::size_t step,
                                            std::size_t steps) {
    const auto tree = CgnsTree::open(path);
    if (!tree) return tree.error();
    std::vector<CgnsNode> solutions;
    for (const CgnsNode& base : tree->children(tree->root()))
        for (const CgnsNode& node : tree->children(base)) {
            if (base.label != "CGNSBase_t" || base.name + "/" + node.name != zone) continue;
            for (const CgnsNode& child : tree->children(node))
                if (child.label == "FlowSolution_t" && is_on_cells(*tree, child)) solutions.push_back(child);
        }
    if (steps > 1 && solutions.size() == steps) solutions = {solutions[step]};
    std::vector<Field> fields;
    for (const CgnsNode& solution : solutions)
        for (const CgnsNode& node : tree->children(solution)) {
            if (node.label != "DataArray_t" || std::ranges::find(fields, node.name, &Field::name) != fields.end())
                continue;
            auto values = tree->reals(node);
            if (!values) return values.error();
            fields.push_back({node.name, *std::move(values)});
        }
    return fields;
}

} // namespace isotet::io::vtk
