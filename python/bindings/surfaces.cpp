// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/string_view.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <isotet/check.hpp>
#include <isotet/read.hpp>
#include <isotet/surface.hpp>
#include <isotet/write.hpp>

#include "arrays.hpp"
#include "call.hpp"
#include "choice.hpp"
#include "parts.hpp"

namespace isotet::python {

using namespace nb::literals;

namespace {

/// Surfaces that were extracted have numbers of points and cells as int64, also where there are none.
bool is_there(const Array& numbers) { return !numbers.empty() || numbers.type() == ScalarType::int64; }

nb::object array_or_none(const Array& array, bool there) { return there ? array_out(array) : nb::none(); }

nb::dict part_out(const SurfacePart& part, const std::vector<std::string>& fields) {
    nb::dict out, means;
    out["triangles"] = part.triangles;
    out["vertices"] = part.vertices;
    out["area"] = part.area;
    out["volume"] = part.closed ? nb::object(nb::float_(part.volume)) : nb::object(nb::none());
    out["closed"] = part.closed;
    out["centre"] = part.centre;
    out["lower"] = part.lower;
    out["upper"] = part.upper;
    for (std::size_t i = 0; i < fields.size(); ++i) means[nb::str(fields[i].c_str())] = part.means[i];
    out["means"] = means;
    return out;
}

[[noreturn]] void refuse(const std::string& sentence) { throw nb::value_error(sentence.c_str()); }

void check_rows(const std::string& what, const Array& array, std::size_t rows, const char* of) {
    if (array.tuples() != rows)
        refuse(what + " has " + std::to_string(array.tuples()) + " rows, but the surface has " + std::to_string(rows) +
               " " + of);
}

void check_triangles(const Array& triangles, std::size_t vertices) {
    triangles.visit([&](auto corners) {
        const auto highest = std::max_element(corners.begin(), corners.end());
        if (highest != corners.end() && static_cast<std::uint64_t>(*highest) >= vertices)
            refuse("triangles has the vertex " + std::to_string(*highest) + ", but the surface has " +
                   std::to_string(vertices) + " vertices, counted from 0");
    });
}

/// The library takes the shapes of a surface for granted.
void check_shapes(const Surface& surface) {
    const std::size_t vertices = surface.vertex_count(), triangles = surface.triangle_count();
    check_triangles(surface.triangles, vertices);
    for (const Field& field : surface.point_fields)
        check_rows("fields['" + field.name + "']", field.values, vertices, "vertices");
    for (const Field& field : surface.cell_fields)
        check_rows("cell_fields['" + field.name + "']", field.values, triangles, "triangles");
    if (!surface.edge_ends.empty()) {
        check_rows("edge_ends", surface.edge_ends, vertices, "vertices");
        check_rows("edge_weights", surface.edge_weights, vertices, "vertices");
    }
    if (!surface.source_cells.empty()) check_rows("source_cells", surface.source_cells, triangles, "triangles");
    if (surface.normals_kind == Normals::none) return;
    const bool of_faces = surface.normals_kind == Normals::face;
    check_rows("normals", surface.normals, of_faces ? triangles : vertices, of_faces ? "triangles" : "vertices");
    if (!surface.normals.empty() && surface.normals.components() != 3)
        refuse("normals has rows of " + std::to_string(surface.normals.components()) +
               " numbers, but must have rows of 3");
}

Array optional_array(const std::optional<ArrayIn>& array) { return array ? array_in(*array) : Array(); }

nb::dict report_out(const SurfaceReport& report) {
    nb::dict out;
    out["vertices"] = report.vertices;
    out["triangles"] = report.triangles;
    out["area"] = report.area;
    out["volume"] = report.volume;
    out["closed"] = report.closed;
    out["sound"] = report.sound;
    out["clean"] = report.clean;
    out["components"] = report.components;
    out["euler"] = report.euler;
    out["genus"] = report.genus;
    out["boundary_edges"] = report.boundary_edges;
    out["inconsistent_edges"] = report.inconsistent_edges;
    out["blamed_edges"] = report.blamed_edges;
    out["hanging_edges"] = report.hanging_edges;
    out["non_manifold_edges"] = report.non_manifold_edges;
    out["equal_corner_triangles"] = report.equal_corner_triangles;
    out["zero_area_triangles"] = report.zero_area_triangles;
    out["duplicate_triangles"] = report.duplicate_triangles;
    out["blamed_duplicates"] = report.blamed_duplicates;
    out["double_sheets"] = report.double_sheets;
    out["touching_vertices"] = report.touching_vertices;
    out["coincident_vertices"] = report.coincident_vertices;
    out["unused_vertices"] = report.unused_vertices;
    out["collapsed_by_welding"] = report.collapsed_by_welding;
    nb::list findings;
    for (const Finding& finding : report.findings) findings.append(nb::make_tuple(finding.what, finding.where));
    out["findings"] = findings;
    return out;
}

} // namespace

void add_surfaces(nb::module_& module) {
    nb::class_<Surface>(module, "Surface")
        .def(
            "__init__",
            [](Surface* self, const ArrayIn& points, const ArrayIn& triangles, std::string_view normals_kind,
               const std::optional<ArrayIn>& normals, const std::optional<ArrayIn>& edge_ends,
               const std::optional<ArrayIn>& edge_weights, const std::optional<ArrayIn>& source_cells,
               const FieldsIn& fields, const FieldsIn& cell_fields) {
                const Normals kind = choice("normals_kind", normals_kind, words_of_normals);
                Surface made{array_in(points),
                             array_in(triangles),
                             kind,
                             optional_array(normals),
                             optional_array(edge_ends),
                             optional_array(edge_weights),
                             optional_array(source_cells),
                             fields_in(fields),
                             fields_in(cell_fields)};
                check_shapes(made);
                new (self) Surface(std::move(made));
            },
            "points"_a, "triangles"_a, "normals_kind"_a, "normals"_a.none(), "edge_ends"_a.none(),
            "edge_weights"_a.none(), "source_cells"_a.none(), "fields"_a, "cell_fields"_a)
        .def_prop_ro("points", [](const Surface& self) { return array_out(self.positions); })
        .def_prop_ro("triangles", [](const Surface& self) { return array_out(self.triangles); })
        .def_prop_ro("normals_kind", [](const Surface& self) { return word_of(self.normals_kind, words_of_normals); })
        .def_prop_ro(
            "normals",
            [](const Surface& self) { return array_or_none(self.normals, self.normals_kind != Normals::none); })
        .def_prop_ro("edge_ends",
                     [](const Surface& self) { return array_or_none(self.edge_ends, is_there(self.edge_ends)); })
        .def_prop_ro("edge_weights",
                     [](const Surface& self) { return array_or_none(self.edge_weights, is_there(self.edge_ends)); })
        .def_prop_ro("source_cells",
                     [](const Surface& self) { return array_or_none(self.source_cells, is_there(self.source_cells)); })
        .def_prop_ro("fields", [](const Surface& self) { return fields_out(self.point_fields); })
        .def_prop_ro("cell_fields", [](const Surface& self) { return fields_out(self.cell_fields); })
        .def_prop_ro("vertex_count", &Surface::vertex_count)
        .def_prop_ro("triangle_count", &Surface::triangle_count)
        .def("area", [](const Surface& self) { return area(self); }, nb::call_guard<nb::gil_scoped_release>());

    module.def(
        "check",
        [](const Surface& surface, bool closed, const Grid* grid, const PointField* field, bool weld, int max_findings,
           const CallOptions& options) {
            CheckOptions how;
            how.closed = closed;
            how.grid = grid;
            how.field = field;
            how.weld = weld;
            how.max_findings = max_findings;
            return report_out(call(options, [&](const Run& run) { return check(surface, how, run); }));
        },
        "surface"_a, "closed"_a, "grid"_a.none(), "field"_a.none(), "weld"_a, "max_findings"_a, "call"_a);

    module.def(
        "find_parts",
        [](const Surface& surface, const CallOptions& options) {
            const SurfaceParts found = call(options, [&](const Run& run) { return find_parts(surface, run); });
            nb::list out;
            for (const SurfacePart& part : found.parts) out.append(part_out(part, found.fields));
            return out;
        },
        "surface"_a, "call"_a);

    module.def(
        "keep_parts",
        [](const Surface& surface, const std::vector<std::uint64_t>& kept, const CallOptions& options) {
            return call(options, [&](const Run& run) -> Result<Surface> {
                const Result<SurfaceParts> found = find_parts(surface, run);
                if (!found) return found.error();
                return keep_parts(surface, *found, kept, run);
            });
        },
        "surface"_a, "kept"_a, "call"_a);

    module.def(
        "parts_touching",
        [](const Surface& surface, const std::string& field, double lower, double upper, const CallOptions& options) {
            return call(options, [&](const Run& run) -> Result<std::vector<std::uint64_t>> {
                const Result<SurfaceParts> found = find_parts(surface, run);
                if (!found) return found.error();
                return parts_touching(surface, *found, {field, lower, upper});
            });
        },
        "surface"_a, "field"_a, "lower"_a, "upper"_a, "call"_a);

    module.def(
        "reduce",
        [](const Surface& surface, double share, double error, const CallOptions& options) {
            return call(options, [&](const Run& run) { return reduce(surface, {share, error}, run); }).surface;
        },
        "surface"_a, "share"_a, "error"_a, "call"_a);

    module.def(
        "write_surface",
        [](const Surface& surface, const std::string& path, const std::string& format, const std::string& compression,
           const CallOptions& options) {
            const WriteOptions how{format, choice("compression", compression, words_of_compression)};
            return call(options, [&](const Run& run) { return write_surface(surface, path, how, run); }).notes;
        },
        "surface"_a, "path"_a, "format"_a, "compression"_a, "call"_a);

    module.def(
        "read_surface",
        [](const std::string& path, const std::string& format, const CallOptions& options) {
            return call(options, [&](const Run& run) { return read_surface(path, {format}, run); }).surface;
        },
        "path"_a, "format"_a, "call"_a);
}

} // namespace isotet::python
