// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/string_view.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include <isotet/contour.hpp>
#include <isotet/extract.hpp>
#include <isotet/pack.hpp>
#include <isotet/solid.hpp>
#include <isotet/surface.hpp>

#include "arrays.hpp"
#include "call.hpp"
#include "choice.hpp"
#include "linear.hpp"
#include "parts.hpp"

namespace isotet::python {

using namespace nb::literals;

namespace {

/// One surface for all isovalues, as the program writes them into one file: several have the cell field "isovalue".
Surface join_all(std::vector<Extraction>&& extractions, const std::vector<double>& isovalues) {
    if (extractions.size() == 1) return std::move(extractions.front().surface);
    std::vector<Surface> surfaces;
    surfaces.reserve(extractions.size());
    for (Extraction& extraction : extractions) surfaces.push_back(std::move(extraction.surface));
    return join(surfaces, isovalues);
}

Array without_tuples(const Array& array) { return {array.type(), nullptr, 0, array.components(), nullptr}; }

/// The surface of no isovalue at all: the arrays of another surface, empty.
Surface empty_like(Surface surface) {
    for (Array* array : {&surface.positions, &surface.triangles, &surface.normals, &surface.edge_ends,
                         &surface.edge_weights, &surface.source_cells})
        *array = without_tuples(*array);
    for (auto* fields : {&surface.point_fields, &surface.cell_fields})
        for (Field& field : *fields) field.values = without_tuples(field.values);
    std::erase_if(surface.cell_fields, [](const Field& field) { return field.name == "isovalue"; });
    surface.cell_fields.push_back({"isovalue", Array::own(std::vector<double>())});
    return surface;
}

/// An isovalue in the range of the field, in place of none.
double some_isovalue(const FieldReport& field) { return field.lower <= field.upper ? field.lower : 0; }

ContourOptions contour_options(std::string_view normals, bool edge_ends, bool source_cells, std::string_view ties,
                               std::string_view precision, std::optional<std::string_view> method,
                               std::uint64_t surfaces, bool split_cells, const Frame* frame,
                               const std::optional<RefineOptions>& refine) {
    ContourOptions options;
    if (method) options.method = choice("method", *method, words_of_method);
    options.surfaces = surfaces;
    options.precision = choice("precision", precision, words_of_precision);
    options.ties = choice("ties", ties, words_of_ties);
    options.normals = choice("normals", normals, words_of_normals);
    options.edge_ends = edge_ends;
    options.source_cells = source_cells;
    options.split_cells = split_cells;
    if (frame) options.frame = *frame;
    options.refine = refine;
    return options;
}

/// Nothing asked for: nothing.
std::optional<RefineOptions> refine_options(std::optional<double> tolerance, std::optional<double> relative_tolerance,
                                            double geometry_tolerance, double distance) {
    if (!tolerance && !relative_tolerance && distance == 0) return std::nullopt;
    RefineOptions options;
    options.tolerance = tolerance.value_or(0);
    options.relative_tolerance = relative_tolerance.value_or(0);
    options.geometry_tolerance = geometry_tolerance;
    options.distance = distance;
    return options;
}

ContourInput contour_input(const Grid& grid, const PointField& field, const FieldsIn& fields,
                           const FieldsIn& cell_fields) {
    return {{grid.points, grid.cells, {}, {}, grid.point_numbers}, field, fields_in(fields), fields_in(cell_fields)};
}

nb::dict field_out(const FieldReport& report) {
    nb::dict out;
    out["name"] = report.name;
    out["lower"] = report.lower;
    out["upper"] = report.upper;
    out["no_data"] = report.no_data;
    out["infinite"] = report.infinite;
    out["flushed"] = report.flushed;
    out["unchanged"] = report.unchanged;
    return out;
}

nb::dict packing_out(const PackReport& report) {
    nb::dict out;
    out["points"] = report.points;
    out["tets"] = report.tets;
    out["clusters"] = report.clusters;
    out["cells_left_out"] = report.cells_left_out;
    out["pyramids"] = report.pyramids;
    out["wedges"] = report.wedges;
    out["hexahedra"] = report.hexahedra;
    out["split_cells"] = report.split_cells;
    out["collapsed_tets"] = report.collapsed_tets;
    out["repeated_tets"] = report.repeated_tets;
    out["negative_tets"] = report.negative_tets;
    out["inverted_tets"] = report.inverted_tets;
    out["flat_tets"] = report.flat_tets;
    out["coarse_clusters"] = report.coarse_clusters;
    out["bytes"] = report.bytes + report.source_bytes + report.gradient_bytes;
    return out;
}

struct Extracted {
    Surface surface;
    std::vector<std::size_t> vertex_counts; ///< of each isovalue
    ContourResult how;                      ///< without surfaces
};

Result<Extracted> extract_nothing(Contour& session, const Run& run) {
    const Result<FieldReport> field = session.field(run);
    if (!field) return field.error();
    Result<ContourResult> result = session.extract(some_isovalue(*field), run);
    if (!result) return result.error();
    Extracted out;
    out.surface = empty_like(std::move(result->surfaces.front().surface));
    out.how = *std::move(result);
    return out;
}

Result<Extracted> extract_joined(Contour& session, const std::vector<double>& isovalues, const Run& run) {
    if (isovalues.empty()) return extract_nothing(session, run);
    Result<ContourResult> result = session.extract(isovalues, run);
    if (!result) return result.error();
    Extracted out;
    for (const Extraction& extraction : result->surfaces)
        out.vertex_counts.push_back(extraction.surface.vertex_count());
    out.surface = join_all(std::move(result->surfaces), isovalues);
    out.how = *std::move(result);
    return out;
}

/// A session, and what it is set to before it extracts.
struct BlockIn {
    Contour* session;
    ContourInput input;
    ContourOptions options;
};

struct BlockOut {
    ContourUpdate update;
    Extracted extracted;
};

/// The same run with the progress of one part of several.
Run run_of_part(const Run& run, std::size_t part, std::size_t parts) {
    Run own = run;
    if (run.progress.report)
        own.progress.report = [&run, part, parts](std::string_view step, double fraction) {
            run.progress.report(step, (static_cast<double>(part) + fraction) / static_cast<double>(parts));
        };
    return own;
}

Result<std::vector<BlockOut>> contour_blocks(std::vector<BlockIn>& blocks, const std::vector<double>& isovalues,
                                             const Run& run) {
    std::vector<BlockOut> out;
    for (std::size_t i = 0; i < blocks.size(); ++i) {
        const Run own = run_of_part(run, i, blocks.size());
        BlockIn& block = blocks[i];
        const Result<ContourUpdate> update = block.session->set(std::move(block.input), block.options, own);
        if (!update) return update.error();
        Result<Extracted> extracted = extract_joined(*block.session, isovalues, own);
        if (!extracted) return extracted.error();
        out.push_back({*update, *std::move(extracted)});
    }
    return out;
}

nb::tuple extracted_out(Extracted&& extracted) {
    nb::dict how;
    how["method"] = word_of(extracted.how.method, words_of_method);
    how["engine"] = extracted.how.engine;
    how["cells_left_out"] = extracted.how.cells_left_out;
    how["coarse_tets"] = extracted.how.coarse_tets;
    how["pack_seconds"] = extracted.how.pack_seconds;
    how["extract_seconds"] = extracted.how.extract_seconds;
    how["notes"] = extracted.how.notes;
    const RefinementReport& refinement = extracted.how.refinement;
    how["field_bound"] = refinement.curved_cells > 0 && refinement.refined
                             ? nb::object(nb::float_(refinement.field_bound))
                             : nb::object(nb::none());
    how["vertex_counts"] = extracted.vertex_counts;
    return nb::make_tuple(std::move(extracted.surface), how);
}

void add_sessions(nb::module_& module) {
    nb::class_<ContourOptions>(module, "ContourOptions")
        .def(
            "__init__",
            [](ContourOptions* self, std::string_view normals, bool edge_ends, bool source_cells, std::string_view ties,
               std::string_view precision, std::optional<std::string_view> method, std::uint64_t surfaces,
               bool split_cells, const Frame* frame, std::optional<double> tolerance,
               std::optional<double> relative_tolerance, double geometry_tolerance, double distance,
               bool exact_vertices, bool extract_while_packing, std::vector<double> expected_isovalues, bool pack_all) {
                new (self) ContourOptions(contour_options(
                    normals, edge_ends, source_cells, ties, precision, method, surfaces, split_cells, frame,
                    refine_options(tolerance, relative_tolerance, geometry_tolerance, distance)));
                self->exact_vertices = exact_vertices;
                self->extract_while_packing = extract_while_packing;
                self->expected_isovalues = std::move(expected_isovalues);
                self->pack_all = pack_all;
            },
            "normals"_a, "edge_ends"_a, "source_cells"_a, "ties"_a, "precision"_a, "method"_a.none(), "surfaces"_a,
            "split_cells"_a = false, "frame"_a.none() = nb::none(), "tolerance"_a.none() = nb::none(),
            "relative_tolerance"_a.none() = nb::none(), "geometry_tolerance"_a = 0.0, "distance"_a = 0.0,
            "exact_vertices"_a = false, "extract_while_packing"_a = false, "expected_isovalues"_a = std::vector<double>(), "pack_all"_a = false)
        .def(
            "refine_for",
            [](ContourOptions& self, const FieldsIn& fields) {
                if (self.refine) self.refine->carried = fields_in(fields);
            },
            "fields"_a);

    nb::class_<Contour>(module, "Contour")
        .def(
            "__init__",
            [](Contour* self, const Grid& grid, const PointField& field, const FieldsIn& fields,
               const FieldsIn& cell_fields, const ContourOptions& options, const CallOptions& how) {
                ContourInput input = contour_input(grid, field, fields, cell_fields);
                new (self)
                    Contour(call(how, [&](const Run& run) { return Contour::create(std::move(input), options, run); }));
            },
            "grid"_a, "field"_a, "fields"_a, "cell_fields"_a, "options"_a, "call"_a)
        .def(
            "set",
            [](Contour& self, const Grid& grid, const PointField& field, const FieldsIn& fields,
               const FieldsIn& cell_fields, const ContourOptions& options, const CallOptions& how) {
                ContourInput input = contour_input(grid, field, fields, cell_fields);
                const ContourUpdate update =
                    call(how, [&](const Run& run) { return self.set(std::move(input), options, run); }, {&self});
                return word_of(update, words_of_update);
            },
            "grid"_a, "field"_a, "fields"_a, "cell_fields"_a, "options"_a, "call"_a)
        .def(
            "extract",
            [](Contour& self, const std::vector<double>& isovalues, const CallOptions& how) {
                return extracted_out(
                    call(how, [&](const Run& run) { return extract_joined(self, isovalues, run); }, {&self}));
            },
            "isovalues"_a, "call"_a)
        .def(
            "prepare",
            [](Contour& self, const CallOptions& how) {
                call(how, [&](const Run& run) { return self.prepare(run); }, {&self});
            },
            "call"_a)
        .def(
            "field",
            [](Contour& self, const CallOptions& how) {
                return field_out(call(how, [&](const Run& run) { return self.field(run); }, {&self}));
            },
            "call"_a)
        .def("packed_bytes",
             [](const Contour& self) -> std::uint64_t {
                 refuse_inside({&self});
                 const nb::gil_scoped_release released;
                 const std::optional<PackedGrid> packed = self.packed();
                 if (!packed) return 0;
                 const PackReport& report = packed->report();
                 return report.bytes + report.source_bytes + report.gradient_bytes;
             })
        .def(
            "method",
            [](const Contour& self, std::size_t isovalues) {
                refuse_inside({&self});
                const nb::gil_scoped_release released;
                return word_of(self.method(isovalues), words_of_method);
            },
            "isovalues"_a);
}

void add_contour_blocks(nb::module_& module) {
    using Block = std::tuple<Contour*, const Grid*, const PointField*, FieldsIn, FieldsIn, const ContourOptions*>;
    module.def(
        "contour_blocks",
        [](const std::vector<Block>& blocks, const std::vector<double>& isovalues, const CallOptions& how) {
            std::vector<BlockIn> in;
            Sessions sessions;
            for (const auto& [session, grid, field, fields, cell_fields, options] : blocks) {
                in.push_back({session, contour_input(*grid, *field, fields, cell_fields), *options});
                sessions.push_back(session);
            }
            nb::list out;
            for (BlockOut& block :
                 call(how, [&](const Run& run) { return contour_blocks(in, isovalues, run); }, std::move(sessions)))
                out.append(
                    nb::make_tuple(word_of(block.update, words_of_update), extracted_out(std::move(block.extracted))));
            return out;
        },
        "blocks"_a, "isovalues"_a, "call"_a);
}

/// Of a Solid and a SolidMeasure.
template <class Told>
nb::dict measure_out(const Told& solid) {
    nb::dict out;
    out["volume"] = solid.volume;
    out["isosurface_area"] = solid.isosurface_area;
    out["boundary_area"] = solid.boundary_area;
    out["isosurface_triangles"] = solid.isosurface_triangles;
    nb::list patches;
    for (const SolidPatch& patch : solid.patches) {
        nb::dict told;
        told["number"] = patch.number;
        told["name"] = patch.name;
        told["triangles"] = patch.triangles;
        told["area"] = patch.area;
        patches.append(told);
    }
    out["patches"] = patches;
    return out;
}

nb::dict solid_out(const Solid& solid, double grid_volume) {
    nb::dict out = measure_out(solid);
    out["grid_volume"] = grid_volume;
    out["open_edges"] = solid.open_edges;
    out["seam_edges"] = solid.seam_edges;
    out["unfit_edges"] = solid.unfit_edges;
    return out;
}

void add_solids(nb::module_& module) {
    module.def(
        "measure_solid",
        [](const Surface& surface, const CallOptions& how) {
            return measure_out(call(how, [&](const Run& run) { return measure_solid(surface, run); }));
        },
        "surface"_a, "call"_a);
    nb::class_<Solids>(module, "Solids")
        .def(
            "__init__",
            [](Solids* self, const Grid& grid, const PointField& field, const FieldsIn& fields,
               const FieldsIn& cell_fields, const ContourOptions& options, const std::optional<ArrayIn>& ghosts,
               const CallOptions& how) {
                ContourInput input = contour_input(grid, field, fields, cell_fields);
                const Array marks = ghosts ? array_in(*ghosts) : Array();
                new (self) Solids(call(how, [&](const Run& run) {
                    return ghosts ? Solids::create_piece(std::move(input), marks, options, run)
                                  : Solids::create(std::move(input), options, run);
                }));
            },
            "grid"_a, "field"_a, "fields"_a, "cell_fields"_a, "options"_a, "ghosts"_a.none(), "call"_a)
        .def(
            "extract",
            [](Solids& self, double lower, double upper, const CallOptions& how) {
                Solid solid = call(how, [&](const Run& run) { return self.extract({lower, upper}, run); });
                const nb::dict told = solid_out(solid, self.grid_volume());
                nb::tuple out = extracted_out({std::move(solid.surface), {}, std::move(solid.contour)});
                nb::cast<nb::dict>(out[1])["solid"] = told;
                return out;
            },
            "lower"_a, "upper"_a, "call"_a)
        .def_prop_ro("grid_volume", &Solids::grid_volume);
}

/// The grid with the arrays beside it as fields.
/// `source_cells`   they were asked for: a grid without cells has them, too
Grid with_sources(const ClippedGrid& clipped, bool source_cells) {
    Grid grid = clipped.grid;
    if (source_cells)
        grid.cell_fields.push_back({"source_cell", clipped.source_cells.empty()
                                                       ? Array::own(std::vector<std::int64_t>())
                                                       : clipped.source_cells});
    if (!clipped.edge_ends.empty()) {
        grid.point_fields.push_back({"edge_ends", clipped.edge_ends});
        grid.point_fields.push_back({"edge_weights", clipped.edge_weights});
    }
    return grid;
}

nb::dict clipped_out(const ClippedGrid& clipped) {
    nb::dict out;
    out["whole_cells"] = clipped.whole_cells;
    out["cut_cells"] = clipped.cut_cells;
    out["polyhedra"] = clipped.polyhedra;
    out["flat_pieces"] = clipped.flat_pieces;
    out["folded_pieces"] = clipped.folded_pieces;
    out["cells_left_out"] = clipped.contour.cells_left_out;
    return out;
}

void add_clippers(nb::module_& module) {
    nb::class_<Clipper>(module, "Clipper")
        .def(
            "__init__",
            [](Clipper* self, const Grid& grid, const PointField& field, const FieldsIn& fields,
               const FieldsIn& cell_fields, const ContourOptions& options, const CallOptions& how) {
                ContourInput input = contour_input(grid, field, fields, cell_fields);
                new (self)
                    Clipper(call(how, [&](const Run& run) { return Clipper::create(std::move(input), options, run); }));
            },
            "grid"_a, "field"_a, "fields"_a, "cell_fields"_a, "options"_a, "call"_a)
        .def(
            "clip",
            [](Clipper& self, double lower, double upper, bool polyhedra, bool source_cells, const CallOptions& how) {
                const ClippedGrid clipped =
                    call(how, [&](const Run& run) { return self.clip({lower, upper}, {polyhedra}, run); });
                return nb::make_tuple(with_sources(clipped, source_cells), clipped_out(clipped), clipped.contour.notes);
            },
            "lower"_a, "upper"_a, "polyhedra"_a, "source_cells"_a, "call"_a);
}

void add_packed_grids(nb::module_& module) {
    nb::class_<PackedGrid>(module, "PackedGrid")
        .def("field", [](const PackedGrid& self) { return field_out(self.field()); })
        .def("report", [](const PackedGrid& self) { return packing_out(self.report()); })
        .def_prop_ro("point_count", &PackedGrid::user_point_count)
        .def_prop_ro("cell_count", &PackedGrid::user_cell_count)
        .def_prop_ro("has_source_cells", [](const PackedGrid& self) { return self.report().source_bytes > 0; })
        .def_prop_ro("precision", [](const PackedGrid& self) { return word_of(self.precision(), words_of_precision); })
        .def(
            "with_field",
            [](const PackedGrid& self, const PointField& field, const CallOptions& how, const LinearGrid* linear) {
                return call(how, [&](const Run& run) -> Result<PackedGrid> {
                    PointField longer = field;
                    Result<Array> values = of_points(linear, field.values, run);
                    if (!values) return values.error();
                    longer.values = *std::move(values);
                    return self.with_field(longer, run);
                });
            },
            "field"_a, "call"_a, "linear"_a.none() = nb::none())
        .def(
            "with_points",
            [](const PackedGrid& self, const ArrayIn& points, const CallOptions& how, const LinearGrid* linear) {
                const Array given = array_in(points);
                return call(how, [&](const Run& run) -> Result<PackedGrid> {
                    const Result<Array> moved = of_points(linear, given, run);
                    if (!moved) return moved.error();
                    return self.with_points(*moved, run);
                });
            },
            "points"_a, "call"_a, "linear"_a.none() = nb::none())
        .def(
            "unpack",
            [](const PackedGrid& self, const CallOptions& how) {
                return call(how, [&](const Run& run) { return unpack(self, run); });
            },
            "call"_a)
        .def(
            "unpack_field",
            [](const PackedGrid& self, const CallOptions& how) {
                return array_out(call(how, [&](const Run& run) { return unpack_field(self, run); }).values);
            },
            "call"_a)
        .def(
            "with_frame",
            [](const PackedGrid& self, const Frame* frame) {
                return self.with_frame(frame ? std::optional<Frame>(*frame) : std::nullopt);
            },
            "frame"_a.none())
        .def(
            "extract",
            [](const PackedGrid& self, const std::vector<double>& isovalues, const FieldsIn& fields,
               const FieldsIn& cell_fields, const ContourOptions& options, const CallOptions& how,
               std::vector<PackedGrid> packed_fields, const LinearGrid* linear) {
                ExtractOptions extraction;
                extraction.ties = options.ties;
                extraction.normals = options.normals;
                extraction.edge_ends = options.edge_ends;
                extraction.source_cells = options.source_cells;
                const std::vector<Field> of_user = fields_in(fields), of_users_cells = fields_in(cell_fields);
                extraction.packed_fields = std::move(packed_fields);
                return call(how, [&](const Run& run) -> Result<Surface> {
                    std::vector<double> values = isovalues;
                    if (isovalues.empty()) values = {some_isovalue(self.field())};
                    auto carried = of_points(linear, of_user, run);
                    if (!carried) return carried.error();
                    extraction.point_fields = *std::move(carried);
                    auto of_triangles = of_cells(linear, of_users_cells, run);
                    if (!of_triangles) return of_triangles.error();
                    extraction.cell_fields = *std::move(of_triangles);
                    Result<std::vector<Extraction>> result = extract(self, values, extraction, run);
                    if (!result) return result.error();
                    number_by_user(linear, *result);
                    if (isovalues.empty()) return empty_like(std::move(result->front().surface));
                    return join_all(*std::move(result), isovalues);
                });
            },
            "isovalues"_a, "fields"_a, "cell_fields"_a, "options"_a, "call"_a, "packed_fields"_a,
            "linear"_a.none() = nb::none());

    module.def(
        "pack",
        [](const Grid& grid, const PointField& field, std::string_view precision, bool source_cells, bool split_cells,
           bool gradients, const Frame* frame, const CallOptions& how) {
            PackOptions options;
            options.precision = choice("precision", precision, words_of_precision);
            options.source_cells = source_cells;
            options.split_cells = split_cells;
            options.gradients = gradients;
            if (frame) options.frame = *frame;
            PackedCells made = call(how, [&](const Run& run) { return pack_linear(grid, field, options, run); });
            nb::object linear = made.linear ? nb::cast(*std::move(made.linear)) : nb::none();
            return nb::make_tuple(std::move(made.packed), std::move(linear));
        },
        "grid"_a, "field"_a, "precision"_a, "source_cells"_a, "split_cells"_a, "gradients"_a, "frame"_a.none(),
        "call"_a);
}

} // namespace

void add_contours(nb::module_& module) {
    add_sessions(module);
    add_contour_blocks(module);
    add_solids(module);
    add_clippers(module);
    add_packed_grids(module);
}

} // namespace isotet::python
