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
#include "io/confined/cgns/cgns_sections.hpp"
#include "io/files/escape.hpp"
#include "io/pieces/cell_list.hpp"
#include "io/pieces/join/shared_faces.hpp"

namespace isotet::io::confined {
namespace {

/// The cells of a zone while they are read. Errors begin without its name.
class CellsReader {
public:
    CellsReader(const CgnsTree& tree, const CgnsZone& zone)
        : tree_(tree), zone_(zone), points_(zone.point_count()), list_(points_) {}

    Result<CgnsCells> read(std::vector<std::string>& notes);
    Result<CgnsCounts> count();

private:
    Result<void> count_dimensions(CgnsSection& section) const;
    Result<void> find_sections();
    Result<void> add_section(const CgnsSection& section, CgnsCells& out);
    Result<void> add_polygons(const CgnsSection& section, CgnsCells& out);
    Result<void> read_face_sections();
    Result<void> check_faces() const;
    std::int64_t index_of_face(std::int64_t number) const;
    Result<void> add_polyhedra(const CgnsSection& section, CgnsCells& out);
    SharedFaces shared_faces(CgnsNumbers faces, CgnsNumbers cell_offsets) const;
    Result<CgnsNumbers> parents() const;
    Result<Cells> cells_of_parents() const;

    const CgnsTree& tree_;
    const CgnsZone& zone_;
    std::uint64_t points_;
    std::vector<CgnsSection> sections_;
    int dimension_ = 3;       ///< of the elements that are cells
    bool by_parents_ = false; ///< faces tell their cells, and there are no others
    bool has_polyhedra_ = false;
    std::vector<CgnsFaceSection> faces_; ///< ascending
    CgnsNumbers faces_of_cells_, cell_offsets_{0};
    std::map<std::string, std::uint64_t> unread_;
    CellList list_;
};

Result<void> CellsReader::count_dimensions(CgnsSection& section) const {
    if (section.type == cgns_mixed)
        return each_cgns_element(tree_, section, [&](const CgnsElement& element, auto) -> Result<void> {
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
    auto sections = cgns_sections(tree_, zone_);
    if (!sections) return sections.error();
    sections_ = *std::move(sections);
    for (CgnsSection& section : sections_)
        if (auto counted = count_dimensions(section); !counted) return counted;
    int largest = 0;
    for (int dimension = 1; dimension <= 3; ++dimension)
        if (std::ranges::any_of(sections_, [&](const CgnsSection& section) { return section.has(dimension); }))
            largest = dimension;
    const auto has_parents = [&](const CgnsSection& section) {
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
    for (const CgnsSection& section : sections_) {
        counts.elements += section.count();
        if (by_parents_) continue;
        const std::uint64_t cells = section.by_dimension[static_cast<std::size_t>(dimension_)];
        const CgnsElement* const element = cgns_element(section.type);
        counts.cells += cells;
        counts.corners += cells * (element ? element->nodes : 1);
    }
    return counts;
}

Result<void> CellsReader::add_section(const CgnsSection& section, CgnsCells& out) {
    std::int64_t number = section.first - 1;
    return each_cgns_element(tree_, section, [&](const CgnsElement& element, auto nodes) -> Result<void> {
        ++number;
        if (element.dimension != dimension_) return {};
        for (const auto node : nodes)
            if (node < 1 || static_cast<std::uint64_t>(node) > points_)
                return section.wrong(
                    fmt::format("has an element with point {}, but the points are 1 to {}", node, points_));
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
Result<void> CellsReader::add_polygons(const CgnsSection& section, CgnsCells& out) {
    constexpr std::uint8_t polygon = 7;
    const auto faces = read_cgns_faces(tree_, section);
    if (!faces) return faces.error();
    for (std::size_t i = 0; i < faces->count(); ++i) {
        const std::int64_t begin = faces->offsets[i], end = faces->offsets[i + 1];
        if (begin < 0 || end < begin || static_cast<std::uint64_t>(end) > faces->values.size())
            return section.wrong(fmt::format("has a face of the numbers {} to {}", begin, end));
        list_.start(polygon, static_cast<std::uint32_t>(end - begin));
        for (std::int64_t at = begin; at < end; ++at) {
            const std::int64_t point = faces->values[static_cast<std::size_t>(at)];
            if (point < 1 || static_cast<std::uint64_t>(point) > points_)
                return section.wrong(
                    fmt::format("has a face with point {}, but the points are 1 to {}", point, points_));
            list_.corner(static_cast<std::uint64_t>(point) - 1);
        }
        out.add_number(section.first + static_cast<std::int64_t>(i));
    }
    return {};
}

/// Faces, and the faces of cells: those of other sections are neither.
Result<void> CellsReader::read_face_sections() {
    for (const CgnsSection& section : sections_) {
        if (section.type != cgns_ngon) continue;
        auto faces = read_cgns_faces(tree_, section);
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
    for (const CgnsFaceSection& section : faces_) {
        if (number >= section.first && number <= section.last) return before + number - section.first;
        before += static_cast<std::int64_t>(section.count());
    }
    return -1;
}

Result<void> check_ends(const CgnsFaceSection& section) {
    if (section.offsets.front() == 0 && section.offsets.back() == static_cast<std::int64_t>(section.values.size()))
        return {};
    return invalid_data(fmt::format("the elements {} to {} have the offsets {} to {}, but {} numbers", section.first,
                                    section.last, section.offsets.front(), section.offsets.back(),
                                    section.values.size()));
}

Result<void> CellsReader::check_faces() const {
    for (const CgnsFaceSection& section : faces_) {
        if (auto sound = check_ends(section); !sound) return sound;
        for (const std::int64_t point : section.values)
            if (point < 1 || static_cast<std::uint64_t>(point) > points_)
                return invalid_data(fmt::format("a face has point {}, but the points are 1 to {}", point, points_));
    }
    return {};
}

/// Cells that tell their faces; signs are dropped.
Result<void> CellsReader::add_polyhedra(const CgnsSection& section, CgnsCells& out) {
    const auto cells = read_cgns_faces(tree_, section);
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
SharedFaces CellsReader::shared_faces(CgnsNumbers faces, CgnsNumbers cell_offsets) const {
    CgnsNumbers points, face_offsets{0};
    for (const CgnsFaceSection& section : faces_) {
        const auto before = static_cast<std::int64_t>(points.size());
        for (std::size_t i = 1; i < section.offsets.size(); ++i) face_offsets.push_back(before + section.offsets[i]);
        for (const std::int64_t point : section.values) points.push_back(point - 1);
    }
    return {Array::own(std::move(points)), Array::own(std::move(face_offsets)), Array::own(std::move(faces)),
            Array::own(std::move(cell_offsets))};
}

/// Cells from 0, those of the left sides and then those of the right ones; -1 where there is none.
Result<CgnsNumbers> CellsReader::parents() const {
    CgnsNumbers all;
    for (const std::size_t side : {0, 1})
        for (const CgnsFaceSection& section : faces_) {
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
        if (cell < 0 || cell - first > max_cgns_element)
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
    CgnsNumbers offsets(static_cast<std::size_t>(most) + 2, 0), faces;
    for (const std::int64_t cell : *sides)
        if (cell >= 0) ++offsets[static_cast<std::size_t>(cell) + 1];
    for (std::size_t i = 1; i < offsets.size(); ++i) offsets[i] += offsets[i - 1];
    faces.resize(static_cast<std::size_t>(offsets.back()));
    CgnsNumbers next = offsets;
    for (std::size_t i = 0; i < sides->size(); ++i)
        if (const std::int64_t cell = (*sides)[i]; cell >= 0)
            faces[static_cast<std::size_t>(next[static_cast<std::size_t>(cell)]++)] =
                static_cast<std::int64_t>(i % count);
    Cells cells;
    cells.types = Array::own(std::vector<std::uint8_t>(static_cast<std::size_t>(most) + 1, core::polyhedron_type));
    cells.offsets = Array::own(CgnsNumbers(static_cast<std::size_t>(most) + 2, 0));
    cells.connectivity = Array::own(CgnsNumbers());
    if (auto done = write_out_faces(shared_faces(std::move(faces), std::move(offsets)), cells); !done)
        return done.error();
    if (auto done = list_points_of_faces(points_, cells); !done) return done.error();
    return cells;
}

Result<CgnsCells> CellsReader::read(std::vector<std::string>& notes) {
    if (auto found = find_sections(); !found) return found.error();
    CgnsCells out;
    for (const CgnsSection& section : sections_) out.elements += section.count();
    has_polyhedra_ = by_parents_ || (dimension_ == 3 &&
                                     std::ranges::find(sections_, cgns_nface, &CgnsSection::type) != sections_.end());
    if (has_polyhedra_)
        if (auto read = read_face_sections(); !read) return read.error();
    if (by_parents_) {
        auto cells = cells_of_parents();
        if (!cells) return cells.error();
        out.cells = *std::move(cells);
        return out;
    }
    for (const CgnsSection& section : sections_) {
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
    if (auto done = write_out_faces(shared_faces(std::move(faces_of_cells_), std::move(cell_offsets_)), out.cells);
        !done)
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
