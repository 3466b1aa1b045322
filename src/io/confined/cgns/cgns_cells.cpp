// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The elements of an unstructured zone, in any order of sections. Polyhedra: faces (NGON_n), and the faces of cells
// (NFACE_n), or the cells on both sides of faces (ParentElements).
#include <algorithm>
#include <array>
#include <cstdlib>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "base/errors.hpp"
#include "grid/cell_faces.hpp"
#include "io/confined/cgns/cgns_elements.hpp"
#include "io/confined/cgns/cgns_zone.hpp"
#include "io/files/escape.hpp"
#include "io/pieces/cell_list.hpp"
#include "io/pieces/shared_faces.hpp"

namespace isotet::io::confined {
namespace {

using Numbers = std::vector<std::int64_t>;

constexpr std::int64_t max_element_number = std::int64_t{1} << 48;

/// Elements_t.
struct Section {
    CgnsNode node;
    std::size_t place = 0; ///< among the sections of the file
    std::int64_t type = 0;
    std::int64_t first = 0, last = 0; ///< numbers of its elements in the zone
    std::array<std::uint64_t, 4> by_dimension{};

    std::uint64_t count() const { return static_cast<std::uint64_t>(last - first) + 1; }
    bool has(int dimension) const { return by_dimension[static_cast<std::size_t>(dimension)] > 0; }
    Error wrong(const std::string& what) const {
        return invalid_data(fmt::format("section \"{}\" {}", escaped(node.name), what));
    }
};

/// A section of faces, or of cells with faces.
struct FaceSection {
    std::int64_t first = 0, last = 0;
    Numbers offsets, values; ///< points of faces, or faces of cells, as the file counts them
    Numbers parents;         ///< of faces: a cell on each side, 0 where there is none; those of the left sides first

    std::size_t count() const { return offsets.size() - 1; }
};

/// Empty where the node is not there.
Result<Numbers> numbers_of(const CgnsTree& tree, const std::vector<CgnsNode>& nodes, const char* name) {
    const auto node = child_named(nodes, name);
    if (!node) return Numbers();
    const auto array = tree.integers(*node);
    if (!array) return array.error();
    return array->visit([](auto values) { return Numbers(values.begin(), values.end()); });
}

/// Ascending by their first numbers.
Result<std::vector<Section>> sections_of(const CgnsTree& tree, const CgnsZone& zone) {
    std::vector<Section> sections;
    for (const CgnsNode& node : zone.parts) {
        if (node.label != "Elements_t") continue;
        Section section{node};
        section.place = sections.size();
        const auto type = tree.integers(node);
        if (!type) return type.error();
        if (type->empty()) return section.wrong("has no type of elements");
        section.type = static_cast<std::int64_t>(type->at(0));
        const auto range = numbers_of(tree, tree.children(node), "ElementRange");
        if (!range) return range.error();
        if (range->size() != 2 || (*range)[0] < 1 || (*range)[1] < (*range)[0] || (*range)[1] > max_element_number)
            return section.wrong("has no range of elements, from 1 on");
        section.first = (*range)[0];
        section.last = (*range)[1];
        sections.push_back(std::move(section));
    }
    std::ranges::sort(sections, {}, [](const Section& section) { return std::pair(section.first, section.place); });
    return sections;
}

/// Calls visit(element, nodes) for each element of a section of one type, or of mixed ones, where a type stands before the
/// nodes. `nodes` is a span of integers of the file.
template <class Visit>
Result<void> each_element(const CgnsTree& tree, const Section& section, const Visit& visit) {
    const CgnsElement* const only = cgns_element(section.type);
    const auto node = child_named(tree.children(section.node), "ElementConnectivity");
    if (!node) return section.wrong("has no ElementConnectivity");
    const auto connectivity = tree.integers(*node);
    if (!connectivity) return connectivity.error();
    return connectivity->visit([&](auto values) -> Result<void> {
        std::size_t at = 0;
        for (std::uint64_t i = 0; i < section.count(); ++i) {
            const CgnsElement* element = only;
            if (!only) {
                if (at == values.size()) return section.wrong(fmt::format("has {} elements, but must have {}", i, section.count()));
                element = cgns_element(static_cast<std::int64_t>(values[at]));
                if (!element)
                    return section.wrong(fmt::format("has an element of type {} among mixed ones", values[at]));
                ++at;
            }
            if (values.size() - at < element->nodes)
                return section.wrong(fmt::format("has {} numbers in \"ElementConnectivity\", which end in its element {} of {}",
                                                 values.size(), i + 1, section.count()));
            if (auto done = visit(*element, values.subspan(at, element->nodes)); !done) return done;
            at += element->nodes;
        }
        if (at != values.size())
            return section.wrong(fmt::format("has {} numbers, but its {} elements need {}", values.size(),
                                             section.count(), at));
        return {};
    });
}

/// Before CGNS 3.4 the number of points or faces stands before each element's.
Result<void> take_counts_out(FaceSection& section) {
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

Result<FaceSection> read_faces(const CgnsTree& tree, const Section& section) {
    const std::vector<CgnsNode> nodes = tree.children(section.node);
    auto values = numbers_of(tree, nodes, "ElementConnectivity");
    if (!values) return values.error();
    auto offsets = numbers_of(tree, nodes, "ElementStartOffset");
    if (!offsets) return offsets.error();
    FaceSection faces{section.first, section.last, *std::move(offsets), *std::move(values), {}};
    if (!child_named(nodes, "ElementStartOffset"))
        if (auto taken = take_counts_out(faces); !taken) return section.wrong(taken.error().message);
    const std::uint64_t elements = section.count();
    if (faces.offsets.size() != elements + 1)
        return section.wrong(fmt::format("has {} offsets for the elements {} to {}, but must have one more than elements",
                                         faces.offsets.size(), section.first, section.last));
    auto parents = numbers_of(tree, nodes, "ParentElements");
    if (!parents) return parents.error();
    faces.parents = *std::move(parents);
    if (!faces.parents.empty() && faces.parents.size() != 2 * elements)
        return section.wrong(
            fmt::format("has {} parents of {} faces, but must have two of each", faces.parents.size(), elements));
    return faces;
}

/// The cells of a zone while they are read. Errors begin without its name.
class CellsReader {
public:
    CellsReader(const CgnsTree& tree, const CgnsZone& zone)
        : tree_(tree), zone_(zone), points_(zone.point_count()), list_(points_) {}

    Result<CgnsCells> read(std::vector<std::string>& notes);
    Result<CgnsCounts> count();

private:
    Result<void> count_dimensions(Section& section) const;
    Result<void> find_sections();
    Result<void> add_section(const Section& section, CgnsCells& out);
    Result<void> add_polygons(const Section& section, CgnsCells& out);
    Result<void> read_face_sections();
    Result<void> check_faces() const;
    std::int64_t index_of_face(std::int64_t number) const;
    Result<void> add_polyhedra(const Section& section, CgnsCells& out);
    SharedFaces shared_faces(Numbers faces, Numbers cell_offsets) const;
    Result<Numbers> parents() const;
    Result<Cells> cells_of_parents() const;

    const CgnsTree& tree_;
    const CgnsZone& zone_;
    std::uint64_t points_;
    std::vector<Section> sections_;
    int dimension_ = 3;              ///< of the elements that are cells
    bool by_parents_ = false;        ///< faces tell their cells, and there are no others
    bool has_polyhedra_ = false;
    std::vector<FaceSection> faces_; ///< ascending
    Numbers faces_of_cells_, cell_offsets_{0};
    std::map<std::string, std::uint64_t> unread_;
    CellList list_;
};

Result<void> CellsReader::count_dimensions(Section& section) const {
    if (section.type == cgns_mixed)
        return each_element(tree_, section, [&](const CgnsElement& element, auto) -> Result<void> {
            ++section.by_dimension[static_cast<std::size_t>(element.dimension)];
            return {};
        });
    const CgnsElement* const element = cgns_element(section.type);
    if (!element && section.type != cgns_ngon && section.type != cgns_nface)
        return section.wrong(fmt::format("has elements of type {}, which CGNS does not know", section.type));
    const int dimension = element ? element->dimension : section.type == cgns_nface ? 3 : 2;
    section.by_dimension[static_cast<std::size_t>(dimension)] = section.count();
    return {};
}

Result<void> CellsReader::find_sections() {
    auto sections = sections_of(tree_, zone_);
    if (!sections) return sections.error();
    sections_ = *std::move(sections);
    for (Section& section : sections_)
        if (auto counted = count_dimensions(section); !counted) return counted;
    int largest = 0;
    for (int dimension = 1; dimension <= 3; ++dimension)
        if (std::ranges::any_of(sections_, [&](const Section& section) { return section.has(dimension); }))
            largest = dimension;
    const auto has_parents = [&](const Section& section) {
        return section.type == cgns_ngon && child_named(tree_.children(section.node), "ParentElements");
    };
    by_parents_ = zone_.cell_dimension == 3 && largest < 3 && std::ranges::any_of(sections_, has_parents);
    dimension_ = by_parents_ ? 3 : std::min(largest, zone_.cell_dimension);
    return {};
}

Result<CgnsCounts> CellsReader::count() {
    if (auto found = find_sections(); !found) return found.error();
    CgnsCounts counts;
    if (by_parents_) counts.cells = zone_.cells.front();
    for (const Section& section : sections_) {
        counts.elements += section.count();
        if (!by_parents_) counts.cells += section.by_dimension[static_cast<std::size_t>(dimension_)];
    }
    return counts;
}

Result<void> CellsReader::add_section(const Section& section, CgnsCells& out) {
    std::int64_t number = section.first - 1;
    return each_element(tree_, section, [&](const CgnsElement& element, auto nodes) -> Result<void> {
        ++number;
        if (element.dimension != dimension_) return {};
        for (const auto node : nodes)
            if (node < 1 || static_cast<std::uint64_t>(node) > points_)
                return section.wrong(fmt::format("has an element with point {}, but the points are 1 to {}", node, points_));
        if (element.vtk_type == 0) ++unread_[std::string(element.name)];
        list_.start(element.vtk_type, element.nodes);
        if (element.order.empty())
            for (const auto node : nodes) list_.corner(static_cast<std::uint64_t>(node) - 1);
        else
            for (const std::uint16_t position : element.order)
                list_.corner(static_cast<std::uint64_t>(nodes[position]) - 1);
        out.add_number(number);
        if (has_polyhedra_) cell_offsets_.push_back(cell_offsets_.back());
        return {};
    });
}

/// Cells of a grid that is flat.
Result<void> CellsReader::add_polygons(const Section& section, CgnsCells& out) {
    constexpr std::uint8_t polygon = 7;
    const auto faces = read_faces(tree_, section);
    if (!faces) return faces.error();
    for (std::size_t i = 0; i < faces->count(); ++i) {
        const std::int64_t begin = faces->offsets[i], end = faces->offsets[i + 1];
        if (begin < 0 || end < begin || static_cast<std::uint64_t>(end) > faces->values.size())
            return section.wrong(fmt::format("has a face of the numbers {} to {}", begin, end));
        list_.start(polygon, static_cast<std::uint32_t>(end - begin));
        for (std::int64_t at = begin; at < end; ++at) {
            const std::int64_t point = faces->values[static_cast<std::size_t>(at)];
            if (point < 1 || static_cast<std::uint64_t>(point) > points_)
                return section.wrong(fmt::format("has a face with point {}, but the points are 1 to {}", point, points_));
            list_.corner(static_cast<std::uint64_t>(point) - 1);
        }
        out.add_number(section.first + static_cast<std::int64_t>(i));
    }
    return {};
}

/// Faces, and the faces of cells: those of other sections are neither.
Result<void> CellsReader::read_face_sections() {
    for (const Section& section : sections_) {
        if (section.type != cgns_ngon) continue;
        auto faces = read_faces(tree_, section);
        if (!faces) return faces.error();
        if (!faces_.empty() && faces->first <= faces_.back().last)
            return invalid_data(fmt::format("sections of faces overlap at element {}", faces->first));
        faces_.push_back(*std::move(faces));
    }
    return check_faces();
}

/// -1: there is no such face.
std::int64_t CellsReader::index_of_face(std::int64_t number) const {
    std::int64_t before = 0;
    for (const FaceSection& section : faces_) {
        if (number >= section.first && number <= section.last) return before + number - section.first;
        before += static_cast<std::int64_t>(section.count());
    }
    return -1;
}

Result<void> check_ends(const FaceSection& section) {
    if (section.offsets.front() == 0 && section.offsets.back() == static_cast<std::int64_t>(section.values.size()))
        return {};
    return invalid_data(fmt::format("the elements {} to {} have the offsets {} to {}, but {} numbers", section.first,
                                    section.last, section.offsets.front(), section.offsets.back(),
                                    section.values.size()));
}

Result<void> CellsReader::check_faces() const {
    for (const FaceSection& section : faces_) {
        if (auto sound = check_ends(section); !sound) return sound;
        for (const std::int64_t point : section.values)
            if (point < 1 || static_cast<std::uint64_t>(point) > points_)
                return invalid_data(fmt::format("a face has point {}, but the points are 1 to {}", point, points_));
    }
    return {};
}

/// Cells that tell their faces; signs are dropped.
Result<void> CellsReader::add_polyhedra(const Section& section, CgnsCells& out) {
    const auto cells = read_faces(tree_, section);
    if (!cells) return cells.error();
    if (auto sound = check_ends(*cells); !sound) return sound;
    const auto before = static_cast<std::int64_t>(faces_of_cells_.size());
    for (const std::int64_t face : cells->values) {
        const std::int64_t index =
            face == std::numeric_limits<std::int64_t>::min() ? -1 : index_of_face(std::abs(face));
        if (index < 0) return invalid_data(fmt::format("a cell has face {}, which is in no section of faces", face));
        faces_of_cells_.push_back(index);
    }
    for (std::size_t i = 0; i < cells->count(); ++i) {
        list_.start(core::polyhedron_type, 0);
        out.add_number(section.first + static_cast<std::int64_t>(i));
        cell_offsets_.push_back(before + cells->offsets[i + 1]);
    }
    return {};
}

/// Sections one after another, all numbers from 0.
SharedFaces CellsReader::shared_faces(Numbers faces, Numbers cell_offsets) const {
    Numbers points, face_offsets{0};
    for (const FaceSection& section : faces_) {
        const auto before = static_cast<std::int64_t>(points.size());
        for (std::size_t i = 1; i < section.offsets.size(); ++i) face_offsets.push_back(before + section.offsets[i]);
        for (const std::int64_t point : section.values) points.push_back(point - 1);
    }
    return {Array::own(std::move(points)), Array::own(std::move(face_offsets)), Array::own(std::move(faces)),
            Array::own(std::move(cell_offsets))};
}

/// Cells from 0, those of the left sides and then those of the right ones; -1 where there is none.
Result<Numbers> CellsReader::parents() const {
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
        if (cell < 0 || cell - first > max_element_number)
            return invalid_data(fmt::format("a face has cell {}, but cells are from {} on", cell, first));
        cell = cell == 0 ? -1 : cell - first;
    }
    return all;
}

Result<Cells> CellsReader::cells_of_parents() const {
    const auto sides = parents();
    if (!sides) return sides.error();
    const std::size_t count = sides->size() / 2;
    const std::int64_t most = *std::ranges::max_element(*sides);
    if (most >= static_cast<std::int64_t>(sides->size()))
        return invalid_data(fmt::format("there are {} cells, but {} faces only", most + 1, count));
    Numbers offsets(static_cast<std::size_t>(most) + 2, 0), faces;
    for (const std::int64_t cell : *sides)
        if (cell >= 0) ++offsets[static_cast<std::size_t>(cell) + 1];
    for (std::size_t i = 1; i < offsets.size(); ++i) offsets[i] += offsets[i - 1];
    faces.resize(static_cast<std::size_t>(offsets.back()));
    Numbers next = offsets;
    for (std::size_t i = 0; i < sides->size(); ++i)
        if (const std::int64_t cell = (*sides)[i]; cell >= 0)
            faces[static_cast<std::size_t>(next[static_cast<std::size_t>(cell)]++)] =
                static_cast<std::int64_t>(i % count);
    Cells cells;
    cells.types = Array::own(std::vector<std::uint8_t>(static_cast<std::size_t>(most) + 1, core::polyhedron_type));
    cells.offsets = Array::own(Numbers(static_cast<std::size_t>(most) + 2, 0));
    cells.connectivity = Array::own(Numbers());
    if (auto done = write_out_faces(shared_faces(std::move(faces), std::move(offsets)), cells); !done)
        return done.error();
    if (auto done = list_points_of_faces(points_, cells); !done) return done.error();
    return cells;
}

Result<CgnsCells> CellsReader::read(std::vector<std::string>& notes) {
    if (auto found = find_sections(); !found) return found.error();
    CgnsCells out;
    for (const Section& section : sections_) out.elements += section.count();
    has_polyhedra_ =
        by_parents_ || (dimension_ == 3 && std::ranges::find(sections_, cgns_nface, &Section::type) != sections_.end());
    if (has_polyhedra_)
        if (auto read = read_face_sections(); !read) return read.error();
    if (by_parents_) {
        auto cells = cells_of_parents();
        if (!cells) return cells.error();
        out.cells = *std::move(cells);
        return out;
    }
    for (const Section& section : sections_) {
        if (!section.has(dimension_)) continue;
        const auto added = section.type == cgns_ngon    ? add_polygons(section, out)
                           : section.type == cgns_nface ? add_polyhedra(section, out)
                                                        : add_section(section, out);
        if (!added) return added.error();
    }
    out.cells = list_.finish();
    for (const auto& [name, count] : unread_)
        notes.push_back(fmt::format("{} elements {} are left out: elements of this type are not read", count, name));
    if (!has_polyhedra_) return out;
    if (auto done = write_out_faces(shared_faces(std::move(faces_of_cells_), std::move(cell_offsets_)), out.cells); !done)
        return done.error();
    if (auto done = list_points_of_faces(points_, out.cells); !done) return done.error();
    return out;
}

} // namespace

Result<CgnsCells> cgns_cells(const CgnsTree& tree, const CgnsZone& zone, std::vector<std::string>& notes) {
    return CellsReader(tree, zone).read(notes);
}

Result<CgnsCounts> count_cgns_cells(const CgnsTree& tree, const CgnsZone& zone) {
    return CellsReader(tree, zone).count();
}

} // namespace isotet::io::confined
