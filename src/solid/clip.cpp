// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/solid.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <mutex>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <isotet/linear_cells.hpp>

#include "base/carry_out.hpp"
#include "base/errors.hpp"
#include "base/system/memory.hpp"
#include "grid/orientation.hpp"
#include "grid/renumber.hpp"
#include "numbers/bounds.hpp"
#include "numbers/storage.hpp"
#include "session/linear_input.hpp"
#include "solid/clipped_arrays.hpp"
#include "solid/cut_cells.hpp"
#include "solid/solid_input.hpp"

namespace isotet {

struct Clipper::Data {
    ContourInput input; ///< with linear cells; tets where cells are split
    ContourOptions options;
    std::shared_ptr<const LinearGrid> linear;
    Array cell_numbers;           ///< SolidInput::cell_numbers
    Array cells_before_splitting; ///< uint64, of each tet; empty: cells are not split
    std::optional<Contour> contour;
    solid::CellFacts facts;
    std::optional<solid::WarpedFaces> warped;
    double flat_within = 0;
    std::vector<std::string> notes;
};

namespace {

using solid::CutCells;
using solid::CutInput;
using solid::CutLevel;
using solid::NewCells;
using solid::NewPoints;
using solid::PointSource;
using solid::WarpedFaces;

/// The input on the tets of its cells.
Result<void> split_all(ContourInput& input, Array& source, const Run& run) {
    if (input.grid.cells.types.empty() && input.grid.cells.uniform_type == CellType::tetrahedron) return {};
    Result<TetList> tets = split(input.grid, run);
    if (!tets) return tets.error();
    core::Buffer<std::int64_t> corners(4 * tets->tets.size());
    core::Buffer<std::uint64_t> cells(tets->cells.size());
    core::parallel_each(tets->tets.size(), 1 << 14, [&](std::size_t i) {
        for (std::size_t k = 0; k < 4; ++k) corners[4 * i + k] = static_cast<std::int64_t>(tets->tets[i][k]);
        cells[i] = tets->cells[i];
    });
    *tets = {};
    for (Field& field : input.cell_fields) field.values = solid::new_cell_values(field.values, cells);
    input.grid.cells = {};
    input.grid.cells.connectivity = std::move(corners).to_array();
    input.grid.cell_fields = {};
    source = std::move(cells).to_array();
    return {};
}

/// Corners of the cells, those of tets of curved cells in the order that faces them outward: nodes of a quadratic wedge go around
/// it the other way than corners of a linear one.
Array with_turned_tets(const Cells& curved, const LinearGrid& linear, const Grid& grid, const core::CellReader& cells) {
    const core::PointReader points(grid.points);
    const auto is_of_curved_cell = [&](std::size_t cell) {
        const std::size_t of = linear.source_cells.empty()
                                   ? cell
                                   : static_cast<std::size_t>(linear.source_cells.as<std::uint64_t>()[cell]);
        return is_curved(curved.types.as<std::uint8_t>()[of]);
    };
    return grid.cells.connectivity.visit([&](auto typed) {
        core::Buffer<std::remove_cvref_t<decltype(typed[0])>> out(typed.size());
        std::ranges::copy(typed, out.begin());
        core::parallel_each(cells.count(), 1 << 14, [&](std::size_t cell) {
            if (cells.type(cell) != static_cast<std::uint8_t>(CellType::tetrahedron) || !is_of_curved_cell(cell))
                return;
            auto* const corners = out.data() + cells.first(cell);
            core::Tet tet;
            for (std::size_t k = 0; k < 4; ++k) tet[k] = static_cast<std::uint64_t>(corners[k]);
            if (points.six_volumes(tet) < 0) std::swap(corners[2], corners[3]);
        });
        return std::move(out).to_array();
    });
}

/// Half of the largest side of the points' box.
double half_extent(const Array& points) {
    core::Bounds bounds;
    std::mutex mutex;
    const core::PointReader reader(points);
    core::parallel_ranges(points.tuples(), 1 << 15, [&](std::size_t begin, std::size_t end) {
        core::Bounds here;
        for (std::size_t i = begin; i < end; ++i) here.add(reader[i]);
        const std::lock_guard lock(mutex);
        bounds.combine(here);
    });
    double largest = 0;
    for (std::size_t axis = 0; axis < 3; ++axis)
        largest = std::max(largest, (bounds.upper[axis] - bounds.lower[axis]) / 2);
    return largest;
}

template <class Real>
core::Buffer<std::uint8_t> flags_of(const Array& values, const FieldReport& field, const SolidRange& range) {
    namespace flag = solid::point_flag;
    const core::Storage storage{field.offset, field.scale, field.unchanged};
    const bool has_lower = std::isfinite(range.lower), has_upper = std::isfinite(range.upper);
    const auto lower = core::store_isovalue<Real>(has_lower ? range.lower : 0, storage);
    const auto upper = core::store_isovalue<Real>(has_upper ? range.upper : 0, storage);
    core::Buffer<std::uint8_t> out(values.tuples());
    values.visit([&](auto typed) {
        core::parallel_each(typed.size(), 1 << 15, [&](std::size_t point) {
            const Real value = core::store_value<Real>(static_cast<double>(typed[point]), storage);
            const bool is_below = has_lower && value < lower.value, is_above = has_upper && value >= upper.value;
            const bool tied = is_above ? value == upper.tied : has_lower && value == lower.tied;
            const std::uint8_t side = is_above ? flag::above : is_below ? flag::below : flag::inside;
            out[point] =
                static_cast<std::uint8_t>(side | (tied ? flag::tied : 0) | (core::is_nan(value) ? flag::no_data : 0));
        });
    });
    return out;
}

/// The faces of the boundary that are not flat.
Result<WarpedFaces> find_warped(const Grid& grid, const Array& values, const Progress& progress) {
    auto all = solid::find_boundary_faces(grid, values, solid::CellMode::native, progress);
    if (!all) return all.error();
    const core::PointReader points(grid.points);
    WarpedFaces out;
    std::erase_if(all->faces, [&](const solid::BoundaryFace& face) {
        if (face.count < 4) return true;
        std::array<solid::Place3, 4> corners;
        for (std::size_t k = 0; k < 4; ++k) corners[k] = points[all->points[face.places[k]]];
        return !solid::is_warped(corners, solid::rounding_of(grid.points.type()) * solid::largest_coordinate(corners));
    });
    std::ranges::stable_sort(all->faces, {}, &solid::BoundaryFace::cell);
    out.boundary = *std::move(all);
    out.points = solid::BoundaryPoints(out.boundary, grid.points.tuples());
    return out;
}

/// Makes one clipped grid.
class ClipRun {
public:
    ClipRun(const ContourInput& input, const ContourOptions& options, const SolidRange& range,
            const core::CellReader& cells, const solid::CellFacts& facts, ContourResult contour)
        : input_(input), options_(options), range_(range), cut_{input.grid, cells, facts,   {}, {}, {},
                                                                {},         0,     nullptr, {}, {}} {
        for (std::size_t i = 0; i < contour.surfaces.size(); ++i) {
            const bool is_lower = i == 0 && std::isfinite(range.lower);
            surfaces_[is_lower ? 0 : 1] = std::exchange(contour.surfaces[i].surface, {});
        }
        contour_ = std::move(contour);
    }

    CutInput& cut_input() { return cut_; }
    ContourResult take_contour() { return std::move(contour_); }

    Result<void> start() {
        const std::uint64_t points = input_.grid.points.tuples();
        cut_.places = {points, surfaces_[0].vertex_count(), surfaces_[1].vertex_count(), 0};
        if (auto ok = check_count(); !ok) return ok;
        const std::uint64_t bytes = 11 * cut_.places.count() + cut_.cells.count();
        if (auto ok = core::require_memory("clipping", bytes); !ok) return ok;
        cut_.flags = options_.precision == Precision::float32
                         ? flags_of<float>(input_.field.values, contour_.field, range_)
                         : flags_of<double>(input_.field.values, contour_.field, range_);
        cut_.lower = {solid::EdgeVertices(surfaces_[0], points), core::PointReader(surfaces_[0].positions)};
        cut_.upper = {solid::EdgeVertices(surfaces_[1], points), core::PointReader(surfaces_[1].positions)};
        return {};
    }

    /// The vertices inside parts of warped faces, where the solid has them.
    Result<void> set_warped(const WarpedFaces& warped) {
        cut_.warped = &warped;
        if (!warped.boundary.faces.empty())
            cut_.cap =
                options_.precision == Precision::float32 ? cap_of_warped<float>(warped) : cap_of_warped<double>(warped);
        cut_.places.apexes = cut_.cap.apexes.size();
        cut_.first_apex.assign(warped.boundary.faces.size() + 1, 0);
        for (const solid::Apex& apex : cut_.cap.apexes) ++cut_.first_apex[apex.face + 1];
        for (std::size_t i = 0; i < warped.boundary.faces.size(); ++i) cut_.first_apex[i + 1] += cut_.first_apex[i];
        return check_count();
    }

    Result<ClippedGrid> make(const CutCells& cells) const {
        ClippedGrid out;
        const NewPoints points = solid::number_points(cut_, cells.used);
        if (auto ok = core::require_memory("the clipped grid", bytes_of(cells, points)); !ok) return ok.error();
        NewCells made = solid::make_cells(cut_, cells, points);
        out.grid.cells = std::move(made.cells);
        const auto source = [&](const Array& grid, const auto& of_surface) {
            return PointSource{grid, of_surface(surfaces_[0]), of_surface(surfaces_[1])};
        };
        const PointSource positions =
            source(input_.grid.points, [](const Surface& surface) { return &surface.positions; });
        out.grid.points = solid::new_positions(positions, cut_, points, options_.precision);
        for (std::size_t i = 0; i < input_.point_fields.size(); ++i) {
            const Field& field = input_.point_fields[i];
            const PointSource values = source(field.values, [&](const Surface& surface) {
                return i < surface.point_fields.size() ? &surface.point_fields[i].values : nullptr;
            });
            out.grid.point_fields.push_back({field.name, solid::new_values(values, cut_, points, options_.precision)});
        }
        for (const Field& field : input_.cell_fields)
            out.grid.cell_fields.push_back({field.name, solid::new_cell_values(field.values, made.origin)});
        if (options_.edge_ends) {
            auto edges = solid::new_edges(surfaces_[0], surfaces_[1], cut_, points, options_.precision);
            out.edge_ends = std::move(edges.ends);
            out.edge_weights = std::move(edges.weights);
        }
        if (options_.source_cells) out.source_cells = std::move(made.origin).to_array();
        for (const solid::BlockPieces& block : cells.blocks) {
            out.whole_cells += block.whole_cells;
            out.cut_cells += block.cut_cells;
            out.polyhedra += block.polyhedra;
            out.flat_pieces += block.flat;
        }
        return out;
    }

private:
    Result<void> check_count() const {
        if (cut_.places.count() <= solid::EdgeVertices::none) return {};
        return invalid_data(fmt::format("the grid and its isosurfaces have {} points, but must have fewer than 2^32",
                                        cut_.places.count()));
    }

    template <class Real>
    solid::Cap cap_of_warped(const WarpedFaces& warped) const {
        const FieldReport& field = contour_.field;
        solid::Cuts<Real> cuts;
        cuts.storage = {field.offset, field.scale, field.unchanged};
        for (const bool of_upper : {false, true}) {
            const double isovalue = of_upper ? range_.upper : range_.lower;
            if (!std::isfinite(isovalue)) continue;
            const Surface& surface = surfaces_[of_upper ? 1 : 0];
            (of_upper ? cuts.upper : cuts.lower) =
                solid::Cut<Real>{core::store_isovalue<Real>(isovalue, cuts.storage), solid::Rim(surface, warped.points),
                                 surface.positions, cuts.vertices};
            cuts.vertices += static_cast<std::uint32_t>(surface.vertex_count());
        }
        return solid::make_cap<Real>(warped.boundary, input_.grid.points, input_.field.values, cuts);
    }

    std::uint64_t bytes_of(const CutCells& cells, const NewPoints& points) const {
        std::uint64_t of_point = 3 * sizeof(double) + (options_.edge_ends ? 24 : 0), of_cell = 8;
        for (const Field& field : input_.point_fields) of_point += field.values.components() * sizeof(double);
        for (const Field& field : input_.cell_fields)
            of_cell += field.values.components() * size_of(field.values.type());
        std::uint64_t count = 0;
        for (const solid::BlockPieces& block : cells.blocks) count += block.whole_cells + block.types.size();
        return solid::bytes_of_cells(cells) + of_point * points.places.size() + of_cell * count;
    }

    const ContourInput& input_;
    const ContourOptions& options_;
    SolidRange range_;
    std::array<Surface, 2> surfaces_; ///< of the lower and the upper end
    ContourResult contour_;
    CutInput cut_;
};

Array as_signed(const Array& numbers) {
    return Array(ScalarType::int64, numbers.data(), numbers.tuples(), 1, numbers.owner().lock());
}

/// What VTK knows of linear cells in place of types of isotet's own.
Array vtk_types(const Array& types) {
    core::Buffer<std::uint8_t> out(types.tuples());
    const auto from = types.as<std::uint8_t>();
    core::parallel_each(out.size(), 1 << 16, [&](std::size_t i) {
        out[i] = from[i] == core::ordered_tetrahedron ? 10 : from[i] == core::ordered_pyramid ? 14 : from[i];
    });
    return std::move(out).to_array();
}

/// Appends -1 or 0 for points that were added.
Array lengthened(const Array& values, std::size_t tuples) {
    return values.visit([&](auto typed) {
        using Value = std::remove_cvref_t<decltype(typed[0])>;
        core::Buffer<Value> out(tuples * values.components());
        std::ranges::copy(typed, out.begin());
        std::fill(out.begin() + typed.size(), out.end(), std::is_integral_v<Value> ? Value(-1) : Value(0));
        return std::move(out).to_array(values.components());
    });
}

/// Every polyhedron as linear cells around a point inside.
Result<void> split_polyhedra(ClippedGrid& clipped, const Run& run) {
    if (clipped.polyhedra == 0) return {};
    Result<LinearGrid> linear = linearize(clipped.grid, {}, run);
    if (!linear) return linear.error();
    const auto replace = [](Array& array, Result<Array> by) -> Result<void> {
        if (!by) return by.error();
        array = *std::move(by);
        return {};
    };
    Grid grid = linear->grid;
    grid.cells.types = vtk_types(grid.cells.types);
    for (Field& field : clipped.grid.point_fields)
        if (auto ok = replace(field.values, linear->extend(field.values, run)); !ok) return ok;
    for (Field& field : clipped.grid.cell_fields)
        if (auto ok = replace(field.values, linear->of_cells(field.values, run)); !ok) return ok;
    if (!clipped.source_cells.empty())
        if (auto ok = replace(clipped.source_cells, linear->of_cells(clipped.source_cells, run)); !ok) return ok;
    if (!clipped.edge_ends.empty()) {
        clipped.edge_ends = lengthened(clipped.edge_ends, grid.points.tuples());
        clipped.edge_weights = lengthened(clipped.edge_weights, grid.points.tuples());
    }
    grid.point_fields = std::move(clipped.grid.point_fields);
    grid.cell_fields = std::move(clipped.grid.cell_fields);
    clipped.grid = std::move(grid);
    clipped.polyhedra = 0;
    clipped.folded_pieces = linear->report.folded;
    return {};
}

} // namespace

Clipper::Clipper(std::unique_ptr<Data> data) : data_(std::move(data)) {}
Clipper::Clipper(Clipper&&) noexcept = default;
Clipper& Clipper::operator=(Clipper&&) noexcept = default;
Clipper::~Clipper() = default;

Result<Clipper> Clipper::create(ContourInput given, const ContourOptions& options, const Run& run) {
    return core::carry_out("starting to clip", run, [&](const Progress& progress) -> Result<Clipper> {
        const Run inside{.progress = progress};
        const Cells user_cells = given.grid.cells;
        if (options.normals != Normals::none) return invalid_argument("cells have no normals, but some were asked for");
        Result<solid::SolidInput> taken = solid::take_input(std::move(given), options, inside);
        if (!taken) return taken.error();
        auto data = std::make_unique<Data>();
        data->linear = std::move(taken->linear);
        data->cell_numbers = std::move(taken->cell_numbers);
        data->input = std::move(taken->input);
        data->input.grid.point_fields = data->input.grid.cell_fields = {};
        data->notes = std::move(taken->notes);
        data->options = options;
        if (options.split_cells)
            if (auto ok = split_all(data->input, data->cells_before_splitting, inside); !ok) return ok.error();
        auto cells = core::CellReader::open(data->input.grid);
        if (!cells) return cells.error();
        if (auto sound = core::check_cells(data->input.grid, *cells, progress); !sound) return sound.error();
        if (data->linear && !options.split_cells && has_curved_cells(user_cells)) {
            data->input.grid.cells.connectivity = with_turned_tets(user_cells, *data->linear, data->input.grid, *cells);
            cells = core::CellReader::open(data->input.grid);
            if (!cells) return cells.error();
        }
        ContourInput of_surfaces = data->input;
        of_surfaces.cell_fields = {};
        ContourOptions surface_options = options;
        surface_options.source_cells = false;
        Result<Contour> contour = solid::contour_of(std::move(of_surfaces), surface_options, {});
        if (!contour) return contour.error();
        data->contour = *std::move(contour);
        if (auto ok = core::require_memory("clipping", data->input.grid.points.tuples()); !ok) return ok.error();
        data->facts = solid::facts_of(*cells, data->input.field.values, progress);
        if (progress.cancelled()) return Error{ErrorCode::cancelled, "starting to clip was cancelled"};
        if (data->input.grid.points.type() == ScalarType::float64 && options.precision == Precision::float32)
            data->flat_within = solid::rounding_of(ScalarType::float32) * half_extent(data->input.grid.points);
        return Clipper(std::move(data));
    });
}

Result<ClippedGrid> Clipper::clip(const SolidRange& range, const ClipOptions& options, const Run& run) {
    if (!data_) return moved_from("the clipper");
    return core::carry_out("clipping", run, [&](const Progress& progress) -> Result<ClippedGrid> {
        Data& data = *data_;
        const Run inside{.progress = progress};
        if (auto ok = solid::check_range(range); !ok) return ok.error();
        Result<ContourResult> contour = data.contour->extract(solid::ends_of_range(range), inside);
        if (!contour) return contour.error();
        const auto cells = core::CellReader::open(data.input.grid);
        if (!cells) return cells.error();
        ClipRun clip(data.input, data.options, range, *cells, data.facts, *std::move(contour));
        clip.cut_input().flat_within = data.flat_within;
        if (auto ok = clip.start(); !ok) return ok.error();
        if (data.warped)
            if (auto ok = clip.set_warped(*data.warped); !ok) return ok.error();
        CutCells cut = solid::cut_cells(clip.cut_input(), progress);
        if (cut.needs_warped && !progress.cancelled()) {
            Result<WarpedFaces> warped = find_warped(data.input.grid, data.input.field.values, progress);
            if (!warped) return warped.error();
            data.warped = *std::move(warped);
            if (auto ok = clip.set_warped(*data.warped); !ok) return ok.error();
            cut = solid::cut_cells(clip.cut_input(), progress);
        }
        if (progress.cancelled()) return Error{ErrorCode::cancelled, "clipping was cancelled"};
        Result<ClippedGrid> out = clip.make(cut);
        if (!out) return out;
        if (!options.polyhedra)
            if (auto ok = split_polyhedra(*out, inside); !ok) return ok.error();
        if (!out->source_cells.empty()) {
            for (const Array& numbers :
                 {data.cells_before_splitting, data.linear ? data.linear->source_cells : Array(), data.cell_numbers})
                out->source_cells = core::source_cells_by(out->source_cells, numbers);
            out->source_cells = as_signed(out->source_cells);
        }
        out->contour = clip.take_contour();
        if (data.linear) {
            out->contour.refinement = data.linear->refinement;
            out->contour.cells_left_out += data.linear->refinement.left_out;
        }
        out->contour.notes.insert(out->contour.notes.begin(), data.notes.begin(), data.notes.end());
        data.notes.clear();
        return out;
    });
}

Result<FieldReport> Clipper::field(const Run& run) {
    if (!data_) return moved_from("the clipper");
    return data_->contour->field(run);
}

Method Clipper::method() const { return data_ ? data_->contour->method() : Method::direct; }

std::shared_ptr<const LinearGrid> Clipper::linear_grid() const { return data_ ? data_->linear : nullptr; }

} // namespace isotet
