// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// check(): the steps, and the rules of what is blamed.
#include <isotet/check.hpp>

#include <algorithm>
#include <limits>
#include <optional>

#include <fmt/core.h>

#include <isotet/linear_cells.hpp>

#include "base/carry_out.hpp"
#include "base/parallel.hpp"
#include "check/components.hpp"
#include "check/grid_faces.hpp"
#include "check/measure.hpp"
#include "check/mesh.hpp"
#include "check/star_inspector.hpp"
#include "check/stars.hpp"
#include "check/weld.hpp"
#include "grid/points/same_place.hpp"
#include "grid/renumber.hpp"

namespace isotet {

namespace {

using namespace checking;

constexpr std::size_t grain = 4096; // vertices or triangles of a block

Error cancelled() { return {ErrorCode::cancelled, "checking the surface was cancelled"}; }

std::string describe(const EdgeUse& edge) {
    return fmt::format("edge {}-{} is used {} time{} forward, {} backward", edge.low, edge.high, edge.forward,
                       edge.forward == 1 ? "" : "s", edge.backward);
}

class Checker {
public:
    Checker(const Surface& surface, const Mesh& mesh, const CheckOptions& options, const Progress& progress)
        : surface_(surface),
          mesh_(mesh),
          options_(options),
          progress_(progress),
          most_(static_cast<std::size_t>(std::max(options.max_findings, 0))) {}

    Result<SurfaceReport> run() {
        report_.vertices = mesh_.vertex_count();
        report_.triangles = mesh_.triangles();
        progress_("check", 0.1);
        const bool narrow =
            std::max(mesh_.vertex_count(), mesh_.triangles()) <= std::numeric_limits<std::uint32_t>::max();
        if (narrow) inspect_stars<std::uint32_t>();
        else inspect_stars<std::uint64_t>();
        if (progress_.cancelled()) return cancelled();
        progress_("check", 0.6);

        if (options_.closed || !options_.grid) blame_without_grid();
        else if (auto blamed = blame_with_grid(); !blamed) return blamed.error();
        progress_("check", 0.7);
        find_measures();
        progress_("check", 0.8);
        find_listed();
        find_coincident();
        if (progress_.cancelled()) return cancelled();
        progress_("check", 1);

        SurfaceReport& r = report_;
        r.closed = r.boundary_edges == 0 && r.inconsistent_edges == 0;
        r.sound = r.blamed_edges == 0 && r.equal_corner_triangles == 0 && r.blamed_duplicates == 0;
        r.clean = r.sound && r.zero_area_triangles == 0 && r.non_manifold_edges == 0 && r.double_sheets == 0 &&
                  r.touching_vertices == 0 && r.coincident_vertices == 0 && r.hanging_edges == 0;
        return std::move(report_);
    }

private:
    void find(std::string what, const core::Point& where) { report_.findings.push_back({std::move(what), where}); }
    core::Point middle_of(const EdgeUse& edge) const {
        const core::Point a = mesh_.position(edge.low), b = mesh_.position(edge.high);
        return {(a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2};
    }
    void find_edge(const EdgeUse& edge) { find(describe(edge), middle_of(edge)); }
    void find_hanging_edge(const EdgeUse& edge) {
        find(fmt::format("edge {}-{} is open at a hanging point: a face of a larger cell meets smaller ones", edge.low,
                         edge.high),
             middle_of(edge));
    }
    void find_triangle(std::uint64_t triangle, std::string what) {
        find(std::move(what), mesh_.position(mesh_.corners(triangle)[0]));
    }

    template <class Index>
    void inspect_stars() {
        const Components<Index> components(mesh_);
        if (progress_.cancelled()) return;
        progress_("check", 0.2);
        Stars<Index> stars = stars_of<Index>(mesh_);
        progress_("check", 0.4);
        const bool keep_all = options_.grid && !options_.closed;
        std::vector<Share> shares(components.count(), Share{});
        std::vector<Tally> tallies((mesh_.vertex_count() + grain - 1) / grain);
        core::parallel_each(tallies.size(), 1, [&](std::size_t block) {
            if (progress_.cancelled()) return;
            StarInspector inspector(mesh_, most_, keep_all);
            const std::uint64_t end = std::min<std::uint64_t>(mesh_.vertex_count(), (block + 1) * grain);
            std::uint64_t component = 0;
            Share sum;
            const auto hand_over = [&] {
                if (sum.euler != 0)
                    std::atomic_ref(shares[component].euler).fetch_add(sum.euler, std::memory_order_relaxed);
                if (!sum.proper) std::atomic_ref(shares[component].proper).store(false, std::memory_order_relaxed);
                sum = {};
            };
            for (std::uint64_t vertex = block * grain; vertex < end; ++vertex) {
                const auto star = stars.of(vertex);
                if (star.empty()) {
                    ++tallies[block].unused;
                    continue;
                }
                if (components.of(vertex) != component) hand_over();
                component = components.of(vertex);
                const Share share = inspector.inspect(vertex, star, tallies[block]);
                sum.euler += share.euler;
                sum.proper &= share.proper;
            }
            hand_over();
        });
        merge(tallies);
        report_.components = components.count();
        for (const Share& share : shares) {
            report_.euler += share.euler;
            if (share.proper) report_.genus.push_back((2 - share.euler) / 2);
        }
    }

    void merge(const std::vector<Tally>& tallies) {
        const auto append = [](auto& list, const auto& more) { list.insert(list.end(), more.begin(), more.end()); };
        for (const Tally& tally : tallies) {
            report_.boundary_edges += tally.boundary_edges;
            report_.inconsistent_edges += tally.inconsistent_edges;
            report_.non_manifold_edges += tally.non_manifold_edges;
            report_.duplicate_triangles += tally.duplicates;
            report_.double_sheets += tally.double_sheets;
            report_.touching_vertices += tally.touching;
            report_.unused_vertices += tally.unused;
            append(lists_.unequal_edges, tally.unequal_edges);
            append(lists_.duplicate_list, tally.duplicate_list);
            append(lists_.non_manifold_list, tally.non_manifold_list);
            append(lists_.double_sheet_list, tally.double_sheet_list);
            append(lists_.touching_list, tally.touching_list);
        }
    }

    template <class List, class Report>
    void first_few(const List& list, const Report& report_one) const {
        for (std::size_t i = 0; i < std::min(list.size(), most_); ++i) report_one(list[i]);
    }

    void find_duplicate(const Repeat& repeat) {
        find_triangle(repeat.triangle, fmt::format("triangle {} repeats triangle {}", repeat.triangle, repeat.earlier));
    }

    void blame_without_grid() {
        report_.blamed_edges = options_.closed ? report_.boundary_edges + report_.inconsistent_edges : 0;
        report_.blamed_duplicates = report_.duplicate_triangles;
        first_few(lists_.unequal_edges, [&](const EdgeUse& edge) { find_edge(edge); });
        first_few(lists_.duplicate_list, [&](const Repeat& repeat) { find_duplicate(repeat); });
    }

    /// The grid points of some vertices; nothing when they are more than a face has.
    template <std::size_t N>
    std::optional<PointSet> grid_points(const std::array<std::uint64_t, N>& vertices) const {
        const core::IndexColumn ends(surface_.edge_ends);
        PointSet set;
        for (const std::uint64_t vertex : vertices)
            if (!set.add(ends[2 * vertex]) || !set.add(ends[2 * vertex + 1])) return std::nullopt;
        return set;
    }

    Result<void> blame_with_grid() {
        const core::IndexColumn ends(surface_.edge_ends);
        const std::uint64_t points = options_.grid->points.tuples();
        for (std::uint64_t i = 0; i < 2 * mesh_.vertex_count(); ++i)
            if (ends[i] >= points)
                return Error{
                    ErrorCode::invalid_data,
                    fmt::format("vertex {} lies on an edge of point {}, but the grid has {} points: it is not the "
                                "grid from which the surface was extracted",
                                i / 2, static_cast<std::int64_t>(ends[i]), points)};
        std::vector<PointSet> sets;
        for (const EdgeUse& edge : lists_.unequal_edges)
            if (const auto set = grid_points<2>({edge.low, edge.high})) sets.push_back(*set);
        for (const Repeat& repeat : lists_.duplicate_list)
            if (const auto set = grid_points<3>(mesh_.corners(repeat.triangle))) sets.push_back(*set);
        const auto faces = GridFaces::find(*options_.grid, options_.field, options_.split_cells,
                                            options_.conforming, sets, progress_);
        if (!faces) return faces.error();

        for (const EdgeUse& edge : lists_.unequal_edges) {
            const auto set = grid_points<2>({edge.low, edge.high});
            if (set && faces->in_boundary_face(*set)) {
                if (faces->in_hanging_face(*set) && report_.hanging_edges++ < most_) find_hanging_edge(edge);
                continue;
            }
            if (report_.blamed_edges++ < most_) find_edge(edge);
        }
        for (const Repeat& repeat : lists_.duplicate_list) {
            const auto set = grid_points<3>(mesh_.corners(repeat.triangle));
            if (set && faces->has_two_cells_on_one_side(*set)) continue;
            if (report_.blamed_duplicates++ < most_) find_duplicate(repeat);
        }
        return {};
    }

    void find_measures() {
        const Measures measures = measure(mesh_, most_);
        report_.area = measures.area;
        report_.volume = measures.volume;
        report_.equal_corner_triangles = measures.equal_corners;
        report_.zero_area_triangles = measures.zero_area;
        const auto find_one = [&](std::uint64_t triangle, std::string_view what) {
            const Corners c = mesh_.corners(triangle);
            find_triangle(triangle, fmt::format("triangle {} ({}, {}, {}) has {}", triangle, c[0], c[1], c[2], what));
        };
        first_few(measures.equal_corners_list, [&](std::uint64_t t) { find_one(t, "equal corners"); });
        first_few(measures.zero_area_list, [&](std::uint64_t t) { find_one(t, "no area"); });
    }

    void find_listed() {
        first_few(lists_.non_manifold_list, [&](const EdgeUse& edge) { find_edge(edge); });
        first_few(lists_.double_sheet_list, [&](const Repeat& pair) {
            find_triangle(pair.triangle, fmt::format("triangles {} and {} lie on the same corners, back to back",
                                                     pair.earlier, pair.triangle));
        });
        first_few(lists_.touching_list, [&](std::uint64_t vertex) {
            find(fmt::format("the triangles around vertex {} are not one fan", vertex), mesh_.position(vertex));
        });
    }

    void find_coincident() {
        if (progress_.cancelled() || options_.weld || mesh_.vertex_count() == 0) return;
        const std::vector<std::uint64_t> lowest = core::lowest_at_same_place(surface_.positions);
        for (std::uint64_t vertex = 0; vertex < lowest.size(); ++vertex)
            if (lowest[vertex] != vertex && report_.coincident_vertices++ < most_)
                find(fmt::format("vertex {} is at the place of vertex {}", vertex, lowest[vertex]),
                     mesh_.position(vertex));
    }

    const Surface& surface_;
    const Mesh& mesh_;
    const CheckOptions& options_;
    const Progress& progress_;
    std::size_t most_;
    SurfaceReport report_;
    Tally lists_;
};

Result<void> check_edge_ends(const Array& ends, const Mesh& mesh) {
    const bool integral = !is_floating(ends.type()) && size_of(ends.type()) >= 4;
    if (mesh.vertex_count() == 0 || (integral && ends.components() == 2 && ends.tuples() == mesh.vertex_count()))
        return {};
    return Error{
        ErrorCode::invalid_argument,
        fmt::format("edge_ends has {} tuples of {} {}, but to check against a grid it must have one of 2 integers "
                    "for each of the {} vertices",
                    ends.tuples(), ends.components(), name_of(ends.type()), mesh.vertex_count())};
}

/// The grid that a surface was extracted from, and the field on it, prepared for checking.
struct Origin {
    Grid grid;
    PointField field;
};

/// With linear cells.
Result<Origin> linear_origin(const Grid& grid, const PointField* field, const Run& run) {
    auto linear = linearize(grid, {}, run);
    if (!linear) return linear.error();
    Origin origin{linear->grid, field ? *field : PointField{}};
    if (!field) return origin;
    auto longer = linear->extend(field->values, run);
    if (!longer) return longer.error();
    origin.field.values = *std::move(longer);
    return origin;
}

/// With points in the order of their numbers. The ends of a surface's vertices become the new indices.
Result<Origin> sorted_origin(const Grid& grid, const PointField* field, Array& ends, const Progress& progress) {
    const auto cells = core::CellReader::open(grid);
    if (!cells) return cells.error();
    if (auto sound = core::check_cells(grid, *cells, progress); !sound) return sound.error();
    if (field && field->values.tuples() != cells->points())
        return Error{ErrorCode::invalid_argument,
                     fmt::format("the field '{}' has {} values, but the grid has {} points", field->name,
                                 field->values.tuples(), cells->points())};
    auto sorted = core::sort_points_by_number(grid);
    if (!sorted) return sorted.error();
    std::vector<std::int64_t> ranks(sorted->original.size()), out;
    for (std::size_t i = 0; i < ranks.size(); ++i) ranks[sorted->original[i]] = static_cast<std::int64_t>(i);
    const core::IndexColumn users(ends);
    for (std::size_t i = 0; i < ends.size(); ++i)
        out.push_back(users[i] < ranks.size() ? ranks[users[i]] : static_cast<std::int64_t>(users[i]));
    ends = Array::own(std::move(out), 2);
    Origin origin{std::move(sorted->grid), field ? *field : PointField{}};
    if (field) origin.field.values = core::in_order(field->values, sorted->original);
    return origin;
}

} // namespace

Result<SurfaceReport> check(const Surface& user_surface, const CheckOptions& user_options, const Run& run) {
    CheckOptions options = user_options;
    std::optional<Origin> linear, sorted;
    if (options.grid && has_cells_to_linearize(options.grid->cells)) {
        auto made = linear_origin(*options.grid, options.field, run);
        if (!made) return made.error();
        linear = *std::move(made);
        options.grid = &linear->grid;
        if (options.field) options.field = &linear->field;
    }
    return core::carry_out("checking the surface", run, [&](const Progress& progress) -> Result<SurfaceReport> {
        Surface surface = user_surface;
        const auto mesh = Mesh::open(surface);
        if (!mesh) return mesh.error();
        if (options.grid)
            if (auto fits = check_edge_ends(surface.edge_ends, *mesh); !fits) return fits.error();
        if (options.grid && !options.grid->point_numbers.empty()) {
            auto made = sorted_origin(*options.grid, options.field, surface.edge_ends, progress);
            if (!made) return made.error();
            sorted = *std::move(made);
            options.grid = &sorted->grid;
            if (options.field) options.field = &sorted->field;
        }
        if (progress.cancelled()) return cancelled();
        if (!options.weld || mesh->vertex_count() == 0) return Checker(surface, *mesh, options, progress).run();
        const Welded welded = weld(surface, *mesh);
        const auto welded_mesh = Mesh::open(welded.surface);
        if (!welded_mesh) return welded_mesh.error();
        auto report = Checker(welded.surface, *welded_mesh, options, progress).run();
        if (report) report->collapsed_by_welding = welded.collapsed;
        return report;
    });
}

} // namespace isotet
