// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/confined/cgns/cgns_patches.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/errors.hpp"
#include "io/confined/cgns/cgns_sections.hpp"
#include "io/files/escape.hpp"

namespace isotet::io::confined {
namespace {

/// BC_t.
struct Condition {
    std::string name, location = "Vertex";
    CgnsNumbers list, range;
    bool of_elements = false; ///< the numbers are those of faces, else of points
};

Result<Condition> condition_of(const CgnsTree& tree, const CgnsNode& node) {
    const std::vector<CgnsNode> parts = tree.children(node);
    Condition out;
    out.name = node.name;
    if (const auto family = child_named(parts, "FamilyName"))
        if (const std::string name = tree.text(*family); !name.empty()) out.name = name;
    if (const auto location = child_named(parts, "GridLocation")) out.location = tree.text(*location);
    for (const char* name : {"PointList", "ElementList"}) {
        auto list = cgns_numbers(tree, parts, name);
        if (!list) return list.error();
        if (!list->empty()) out.list = *std::move(list);
    }
    for (const char* name : {"PointRange", "ElementRange"}) {
        auto range = cgns_numbers(tree, parts, name);
        if (!range) return range.error();
        if (!range->empty()) out.range = *std::move(range);
    }
    const auto is_of = [&](const char* what) { return out.location.find(what) != std::string::npos; };
    out.of_elements = is_of("Face") || is_of("Cell") || child_named(parts, "ElementList") || // Gmsh writes "CellCenter"
                      child_named(parts, "ElementRange");
    return out;
}

class PatchReader {
public:
    PatchReader(const CgnsTree& tree, const CgnsZone& zone, core::PatchList& numbers)
        : tree_(tree), zone_(zone), numbers_(numbers) {}

    Result<BoundaryPatches> read() {
        for (const CgnsNode& all : zone_.parts) {
            if (all.label != "ZoneBC_t") continue;
            for (const CgnsNode& node : tree_.children(all)) {
                if (node.label != "BC_t") continue;
                const auto condition = condition_of(tree_, node);
                if (!condition) return condition.error();
                if (auto added = add(*condition); !added)
                    return invalid_data(
                        fmt::format("boundary condition \"{}\" {}", escaped(node.name), added.error().message));
            }
        }
        return list_.finish();
    }

private:
    Result<void> add(const Condition& condition) {
        const bool is_known = condition.of_elements || condition.location == "Vertex";
        if (!is_known || (condition.list.empty() && condition.range.empty())) return {};
        if (zone_.is_structured)
            return condition.range.empty() || condition.location == "CellCenter" ? Result<void>{}
                                                                                 : add_range_of_lattice(condition);
        if (!condition.range.empty() && (condition.range.size() != 2 || condition.range[1] < condition.range[0]))
            return invalid_data("has no range");
        return condition.of_elements ? add_elements(condition) : add_points(condition);
    }

    /// The points since the last face are one of this condition.
    void end_face(const Condition& condition) {
        const std::int64_t number = numbers_.number_of(condition.name);
        list_.name(number, condition.name);
        list_.end_face(number);
    }

    /// All points of a patch as one face.
    Result<void> add_points(const Condition& condition) {
        std::vector<std::int64_t> ends = condition.range;
        ends.insert(ends.end(), condition.list.begin(), condition.list.end());
        for (const std::int64_t point : ends)
            if (point < 1 || static_cast<std::uint64_t>(point) > zone_.point_count())
                return invalid_data(
                    fmt::format("has point {}, but the points are 1 to {}", point, zone_.point_count()));
        for (const std::int64_t point : condition.list) list_.point(point - 1);
        if (!condition.range.empty())
            for (std::int64_t point = condition.range[0]; point <= condition.range[1]; ++point) list_.point(point - 1);
        end_face(condition);
        return {};
    }

    /// Of faces, the axis along which their range has one number is across them, and they have a point more along the others.
    Result<void> add_range_of_lattice(const Condition& condition) {
        const std::size_t axes = zone_.points.size();
        if (condition.range.size() != 2 * axes || axes > 3) return invalid_data("has no range");
        std::array<std::int64_t, 3> low{1, 1, 1}, high{1, 1, 1};
        bool across = condition.of_elements;
        for (std::size_t axis = 0; axis < axes; ++axis) {
            low[axis] = std::min(condition.range[axis], condition.range[axes + axis]);
            high[axis] = std::max(condition.range[axis], condition.range[axes + axis]);
            const bool is_across = across && low[axis] == high[axis] && is_across_axis(condition.location, axis);
            if (is_across) across = false;
            else if (condition.of_elements) ++high[axis];
            if (low[axis] < 1 || static_cast<std::uint64_t>(high[axis]) > zone_.points[axis])
                return invalid_data(
                    fmt::format("has points up to {} along an axis of {}", high[axis], zone_.points[axis]));
        }
        const auto width = static_cast<std::int64_t>(zone_.points[0]);
        const auto height = axes > 1 ? static_cast<std::int64_t>(zone_.points[1]) : 1;
        for (std::int64_t k = low[2]; k <= high[2]; ++k)
            for (std::int64_t j = low[1]; j <= high[1]; ++j)
                for (std::int64_t i = low[0]; i <= high[0]; ++i)
                    list_.point(i - 1 + width * (j - 1 + height * (k - 1)));
        end_face(condition);
        return {};
    }

    /// "IFaceCenter" is across the first axis; "FaceCenter" across any.
    static bool is_across_axis(const std::string& location, std::size_t axis) {
        return !location.ends_with("FaceCenter") || location.size() == 10 || location[0] == "IJK"[axis];
    }

    /// Elements that are no faces are passed over.
    Result<void> add_elements(const Condition& condition) {
        if (auto read = read_faces(); !read) return read;
        const auto add_one = [&](std::int64_t element) {
            const auto after = std::ranges::upper_bound(sections_, element, {}, &Faces::first);
            if (after == sections_.begin() || element - std::prev(after)->first >= std::prev(after)->count()) return;
            const Faces& faces = *std::prev(after);
            const auto at = static_cast<std::size_t>(element - faces.first);
            if (faces.begins[at] == faces.begins[at + 1]) return;
            for (std::size_t i = faces.begins[at]; i < faces.begins[at + 1]; ++i) list_.point(faces.points[i]);
            end_face(condition);
        };
        for (const std::int64_t element : condition.list) add_one(element);
        if (condition.range.empty() || sections_.empty()) return {};
        const std::int64_t first = std::max(condition.range[0], sections_.front().first);
        const std::int64_t last = std::min(condition.range[1], sections_.back().first + sections_.back().count() - 1);
        for (std::int64_t element = first; element <= last; ++element) add_one(element);
        return {};
    }

    /// A section of faces; elements that are none have no points.
    struct Faces {
        std::int64_t first = 0;
        std::vector<std::size_t> begins{0};
        std::vector<std::int64_t> points; ///< from 0

        std::int64_t count() const { return static_cast<std::int64_t>(begins.size()) - 1; }
    };

    Result<void> read_faces() {
        if (!sections_.empty()) return {};
        const auto sections = cgns_sections(tree_, zone_);
        if (!sections) return sections.error();
        for (const CgnsSection& section : *sections) {
            if (section.type == cgns_nface) continue;
            const CgnsElement* const element = cgns_element(section.type);
            if (element && element->dimension != 2) continue;
            Faces faces{section.first, {0}, {}};
            const auto read = section.type == cgns_ngon ? add_polygons(section, faces) : add_section(section, faces);
            if (!read) return read;
            sections_.push_back(std::move(faces));
        }
        return {};
    }

    Result<void> add_point(std::int64_t point, Faces& faces) const {
        if (point < 1 || static_cast<std::uint64_t>(point) > zone_.point_count())
            return invalid_data(
                fmt::format("has a face with point {}, but the points are 1 to {}", point, zone_.point_count()));
        faces.points.push_back(point - 1);
        return {};
    }

    Result<void> add_section(const CgnsSection& section, Faces& faces) const {
        return each_cgns_element(tree_, section, [&](const CgnsElement& element, auto nodes) -> Result<void> {
            for (std::size_t k = 0; element.dimension == 2 && k < nodes.size(); ++k)
                if (auto added = add_point(static_cast<std::int64_t>(nodes[k]), faces); !added) return added;
            faces.begins.push_back(faces.points.size());
            return {};
        });
    }

    Result<void> add_polygons(const CgnsSection& section, Faces& faces) const {
        const auto read = read_cgns_faces(tree_, section);
        if (!read) return read.error();
        for (std::size_t i = 0; i < read->count(); ++i) {
            const std::int64_t begin = read->offsets[i], end = read->offsets[i + 1];
            if (begin < 0 || end < begin || static_cast<std::uint64_t>(end) > read->values.size())
                return section.wrong(fmt::format("has a face of the numbers {} to {}", begin, end));
            for (std::int64_t at = begin; at < end; ++at)
                if (auto added = add_point(read->values[static_cast<std::size_t>(at)], faces); !added) return added;
            faces.begins.push_back(faces.points.size());
        }
        return {};
    }

    const CgnsTree& tree_;
    const CgnsZone& zone_;
    core::PatchList& numbers_;
    core::PatchList list_;
    std::vector<Faces> sections_; ///< ascending
};

} // namespace

Result<BoundaryPatches> cgns_patches(const CgnsTree& tree, const CgnsZone& zone, core::PatchList& numbers) {
    return PatchReader(tree, zone, numbers).read();
}

} // namespace isotet::io::confined
