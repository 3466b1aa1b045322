// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include <isotet/contour.hpp>
#include <isotet/fields.hpp>
#include <isotet/first_view.hpp>
#include <isotet/grid.hpp>
#include <isotet/isovalues.hpp>
#include <isotet/linear_cells.hpp>
#include <isotet/make.hpp>
#include <isotet/read.hpp>
#include <isotet/slice.hpp>
#include <isotet/write.hpp>

#include "arrays.hpp"
#include "call.hpp"
#include "choice.hpp"
#include "parts.hpp"

namespace isotet::python {

using namespace nb::literals;

namespace {

using Names = std::optional<std::vector<std::string>>;

Cells cells_in(const ArrayIn& connectivity, const std::optional<ArrayIn>& offsets, const std::optional<ArrayIn>& types,
               int uniform_type, const std::optional<ArrayIn>& faces, const std::optional<ArrayIn>& face_offsets) {
    Cells cells;
    cells.connectivity = array_in(connectivity);
    if (offsets) cells.offsets = array_in(*offsets);
    if (types) cells.types = array_in(*types);
    if (faces) cells.faces = array_in(*faces);
    if (face_offsets) cells.face_offsets = array_in(*face_offsets);
    cells.uniform_type = static_cast<CellType>(uniform_type);
    return cells;
}

Grid renewed_grid(Grid grid) {
    Cells& cells = grid.cells;
    for (Array* array : {&grid.points, &grid.point_numbers, &cells.connectivity, &cells.offsets, &cells.types,
                         &cells.faces, &cells.face_offsets})
        *array = renewed(*array);
    for (auto* fields : {&grid.point_fields, &grid.cell_fields})
        for (Field& field : *fields) field.values = renewed(field.values);
    return grid;
}

nb::tuple cells_out(const Cells& cells) {
    const auto optional = [](const Array& array) { return array.empty() ? nb::none() : array_out(array); };
    return nb::make_tuple(array_out(cells.connectivity), optional(cells.offsets), optional(cells.types),
                          static_cast<int>(cells.uniform_type), optional(cells.faces), optional(cells.face_offsets));
}

nb::dict info_out(const FileInfo& info) {
    nb::dict fields, cell_fields, out;
    for (const FieldInfo& field : info.fields) {
        nb::dict& of = field.association == Association::point ? fields : cell_fields;
        const std::string_view type = name_of(field.type);
        of[field.name.c_str()] = nb::make_tuple(nb::str(type.data(), type.size()), field.components);
    }
    out["format"] = info.format;
    out["fields"] = fields;
    out["cell_fields"] = cell_fields;
    out["times"] = info.times;
    nb::list blocks, regions;
    for (const BlockInfo& block : info.blocks) {
        nb::dict entry;
        entry["number"] = block.number;
        entry["name"] = block.name;
        entry["kind"] = block.kind;
        entry["cells"] = block.cells;
        blocks.append(entry);
    }
    for (const RegionName& region : info.regions)
        regions.append(nb::make_tuple(region.field, region.number, region.name));
    out["blocks"] = blocks;
    out["regions"] = regions;
    nb::list marked;
    for (const FieldInfo& field : info.fields)
        if (field.active) marked.append(nb::make_tuple(field.name, field.association == Association::cell));
    out["marked"] = marked;
    return out;
}

nb::list formats_out() {
    nb::list out;
    for (const Format& format : formats()) {
        nb::dict entry;
        entry["name"] = format.name;
        entry["title"] = format.title;
        entry["extensions"] = format.extensions;
        entry["reads_grid"] = format.reads_grid;
        entry["writes_grid"] = format.writes_grid;
        entry["reads_surface"] = format.reads_surface;
        entry["writes_surface"] = format.writes_surface;
        entry["reader_process"] = format.reader_process;
        out.append(entry);
    }
    return out;
}

} // namespace

void add_grids(nb::module_& module) {
    nb::class_<Cells>(module, "Cells")
        .def(
            "__init__",
            [](Cells* self, const ArrayIn& connectivity, const std::optional<ArrayIn>& offsets,
               const std::optional<ArrayIn>& types, int uniform_type, const std::optional<ArrayIn>& faces,
               const std::optional<ArrayIn>& face_offsets) {
                new (self) Cells(cells_in(connectivity, offsets, types, uniform_type, faces, face_offsets));
            },
            "connectivity"_a, "offsets"_a.none(), "types"_a.none(), "uniform_type"_a, "faces"_a.none() = nb::none(),
            "face_offsets"_a.none() = nb::none())
        .def("__len__", &Cells::count)
        .def("arrays", &cells_out);

    module.def(
        "contours_cell", [](std::uint8_t type) { return Contour::contours(type) || is_curved(type); }, "type"_a);

    nb::class_<Grid>(module, "Grid")
        .def(
            "__init__",
            [](Grid* self, const ArrayIn& points, const Cells& cells, const FieldsIn& fields,
               const FieldsIn& cell_fields, const std::optional<ArrayIn>& point_numbers) {
                new (self) Grid{array_in(points), cells, fields_in(fields), fields_in(cell_fields), {}};
                if (point_numbers) self->point_numbers = array_in(*point_numbers);
            },
            "points"_a, "cells"_a, "fields"_a, "cell_fields"_a, "point_numbers"_a.none() = nb::none())
        .def("renewed", [](const Grid& self) { return renewed_grid(self); })
        .def_prop_ro("points", [](const Grid& self) { return array_out(self.points); })
        .def_prop_ro("cells", [](const Grid& self) { return self.cells; }) // shares the arrays
        .def_prop_ro(
            "point_numbers",
            [](const Grid& self) { return self.point_numbers.empty() ? nb::none() : array_out(self.point_numbers); })
        .def_prop_ro("fields", [](const Grid& self) { return fields_out(self.point_fields); })
        .def_prop_ro("cell_fields", [](const Grid& self) { return fields_out(self.cell_fields); });

    nb::class_<PointField>(module, "PointField")
        .def(
            "__init__",
            [](PointField* self, const std::string& name, const ArrayIn& values) {
                new (self) PointField{.name = name, .values = array_in(values), .averaged = false, .note = {}};
            },
            "name"_a, "values"_a)
        .def_ro("name", &PointField::name)
        .def_ro("averaged", &PointField::averaged)
        .def_ro("note", &PointField::note)
        .def_prop_ro("values", [](const PointField& self) { return array_out(self.values); });

    module.def(
        "find_field",
        [](const Grid& grid, const std::string& name, bool for_pieces, bool own_centres, const CallOptions& options) {
            FindFieldOptions how;
            how.for_pieces = for_pieces;
            how.keep_cell_values = own_centres;
            if (own_centres) how.prefer = Association::cell;
            return call(options, [&](const Run& run) { return find_field(grid, name, how, run); });
        },
        "grid"_a, "name"_a, "for_pieces"_a, "own_centres"_a, "call"_a);
    module.def("looks_like_expression", [](const std::string& text) { return looks_like_expression(text); }, "text"_a);

    using Vector = std::array<double, 3>;
    const auto add_slice_field = [&module]<class Shape>(const char* name, Shape shape_of) {
        module.def(
            name,
            [shape_of](const ArrayIn& points, const Vector& place, const Vector& direction, double size,
                       const CallOptions& options) {
                const Array array = array_in(points);
                const SliceShape shape = shape_of(place, direction, size);
                return call(options, [&](const Run& run) { return slice_field(array, shape, run); });
            },
            "points"_a, "place"_a, "direction"_a, "size"_a, "call"_a);
    };
    add_slice_field("plane_field",
                    [](const Vector&, const Vector& normal, double offset) { return Plane{normal, offset}; });
    add_slice_field("sphere_field",
                    [](const Vector& centre, const Vector&, double radius) { return Sphere{centre, radius}; });
    add_slice_field("cylinder_field", [](const Vector& point, const Vector& axis, double radius) {
        return Cylinder{axis, point, radius};
    });

    module.def(
        "isovalues_at",
        [](const Grid& grid, const PointField& field, const std::vector<double>& percents, bool of_volume,
           const CallOptions& options) {
            std::vector<IsovalueShare> shares;
            for (const double percent : percents)
                shares.push_back({of_volume ? IsovalueShare::Of::volume : IsovalueShare::Of::points, percent});
            return call(options, [&](const Run& run) { return isovalues_at(grid, field, shares, run); });
        },
        "grid"_a, "field"_a, "percents"_a, "of_volume"_a, "call"_a);

    module.def(
        "contour_spectrum",
        [](const Grid& grid, const PointField& field, const std::vector<double>& isovalues, const CallOptions& options) {
            const ContourSpectrum measured =
                call(options, [&](const Run& run) { return contour_spectrum(grid, field, isovalues, run); });
            nb::dict out;
            out["area"] = array_out(Array::own(measured.area));
            out["volume_below"] = array_out(Array::own(measured.volume_below));
            out["volume"] = measured.volume;
            out["tets"] = measured.tets;
            out["no_data_tets"] = measured.no_data_tets;
            return out;
        },
        "grid"_a, "field"_a, "isovalues"_a, "call"_a);

    module.def(
        "first_view",
        [](const Grid& grid, const std::vector<std::pair<std::string, bool>>& marked) {
            std::vector<FieldInfo> fields = describe_fields(grid);
            for (FieldInfo& field : fields) {
                const std::pair own(field.name, field.association == Association::cell);
                field.active = std::ranges::find(marked, own) != marked.end();
            }
            FirstView view;
            {
                const nb::gil_scoped_release release;
                view = first_view(grid, fields);
            }
            constexpr std::array draws{"isosurfaces", "field_on_boundary", "regions_on_boundary", "boundary"};
            nb::dict out;
            out["draw"] = draws[static_cast<std::size_t>(view.draw)];
            out["field"] = view.field.empty() ? nb::object(nb::none()) : nb::object(nb::str(view.field.c_str()));
            out["cell_field"] = view.association == Association::cell && !view.field.empty();
            out["why"] = std::string(text_of(view.reason));
            return out;
        },
        "grid"_a, "marked"_a);

    nb::class_<ReadOptions>(module, "ReadOptions")
        .def(
            "__init__",
            [](ReadOptions* self, const std::string& format, const std::string& reader_program, const Names& fields,
               const Names& cell_fields, std::optional<std::size_t> step, bool merge_pieces, bool allow_outside,
               const std::string& displace, const std::vector<std::string>& blocks) {
                new (self) ReadOptions();
                self->format = format;
                self->reader_program = reader_program;
                self->point_fields = fields;
                self->cell_fields = cell_fields;
                self->step = step;
                self->merge_pieces_by_coordinates = merge_pieces;
                self->allow_outside = allow_outside;
                self->patches = true;
                self->displace = displace;
                self->blocks = blocks;
            },
            "format"_a, "reader_program"_a, "fields"_a.none() = nb::none(), "cell_fields"_a.none() = nb::none(),
            "step"_a.none() = nb::none(), "merge_pieces"_a = true, "allow_outside"_a = false, "displace"_a = "",
            "blocks"_a = std::vector<std::string>());

    module.def(
        "read",
        [](const std::string& path, const ReadOptions& how, const CallOptions& options) {
            ReadResult result = call(options, [&](const Run& run) { return read(path, how, run); });
            return nb::make_tuple(std::move(result.grid), info_out(result.info), result.step, result.notes);
        },
        "path"_a, "how"_a, "call"_a);

    module.def(
        "inspect",
        [](const std::string& path, const ReadOptions& how, const CallOptions& options) {
            return info_out(call(options, [&](const Run& run) { return inspect(path, how, run); }));
        },
        "path"_a, "how"_a, "call"_a);

    module.def(
        "merge_points",
        [](const Grid& grid, double tolerance, bool means, const CallOptions& options) {
            const MergeOptions how{tolerance, means ? MergedValues::mean : MergedValues::lowest};
            MergedPoints merged = call(options, [&](const Run& run) { return merge_points(grid, how, run); });
            nb::dict report, jumps;
            report["merged"] = merged.merged;
            report["collapsed_cells"] = merged.collapsed_cells;
            for (const FieldJump& jump : merged.jumps) jumps[jump.field.c_str()] = jump.largest;
            report["jumps"] = jumps;
            return nb::make_tuple(std::move(merged.grid), report);
        },
        "grid"_a, "tolerance"_a, "means"_a, "call"_a);

    module.def(
        "close_hanging_points",
        [](const Grid& grid, bool interpolate, const CallOptions& options) {
            ClosedGrid closed = call(options, [&](const Run& run) { return close_hanging_points(grid, run); });
            nb::dict report, differences;
            report["points"] = closed.report.points;
            report["levels"] = closed.report.levels;
            report["cells"] = closed.report.cells;
            report["faces"] = closed.report.faces;
            report["near_faces"] = closed.report.near_faces;
            report["largest_distance"] = closed.report.largest_distance;
            report["open_faces"] = closed.report.open_faces;
            report["curved_cells"] = closed.report.curved_cells;
            for (Field& field : closed.grid.point_fields) {
                const Array& values = field.values;
                differences[field.name.c_str()] =
                    call(options, [&](const Run& run) { return closed.largest_difference(values, run); });
                if (interpolate)
                    field.values = call(options, [&](const Run& run) { return closed.interpolated(values, run); });
            }
            report["differences"] = differences;
            return nb::make_tuple(std::move(closed.grid), report);
        },
        "grid"_a, "interpolate"_a, "call"_a);

    module.def(
        "write_grid",
        [](const Grid& grid, const std::string& path, const std::string& format, const std::string& compression,
           const CallOptions& options) {
            const WriteOptions how{format, choice("compression", compression, words_of_compression)};
            return call(options, [&](const Run& run) { return write_grid(grid, path, how, run); }).notes;
        },
        "grid"_a, "path"_a, "format"_a, "compression"_a, "call"_a);

    module.def(
        "make",
        [](const std::string& shape, std::uint64_t side, const std::vector<std::string>& fields, std::uint64_t seed,
           const CallOptions& options) {
            const MakeOptions how{shape, side, fields, seed};
            return call(options, [&](const Run& run) { return make_grid(how, run); });
        },
        "shape"_a, "side"_a, "fields"_a, "seed"_a, "call"_a);

    module.def("formats", &formats_out);
}

} // namespace isotet::python
