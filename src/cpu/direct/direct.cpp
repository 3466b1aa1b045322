// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "cpu/direct/direct.hpp"

#include <algorithm>
#include <bit>
#include <optional>

#include <fmt/core.h>

#include "base/system/memory.hpp"
#include "base/workers.hpp"
#include "cpu/direct/emit.hpp"
#include "cpu/direct/normals.hpp"
#include "cpu/extract.hpp"
#include "grid/tet_survey.hpp"
#include "packed/frame.hpp"

namespace isotet::cpu::direct {

namespace {

/// Thrown where cells matter that an active filter left out.
struct NeedsAllCells {};

Error cancelled() { return {ErrorCode::cancelled, "extraction was cancelled"}; }

/// Asking how much is free takes longer than extracting a small surface.
Result<void> require_if_much(std::string_view what, std::uint64_t bytes) {
    if (bytes <= std::uint64_t{1} << 26) return {};
    return core::require_memory(what, bytes);
}

/// The same progress, its fractions between `begin` and `end`.
Progress part_of(const Progress& progress, double begin, double end) {
    Progress part;
    part.cancel = progress.cancel;
    if (progress.report)
        part.report = [&report = progress.report, begin, end](std::string_view step, double fraction) {
            report(step, begin + fraction * (end - begin));
        };
    return part;
}

bool any_unseen(Sides& sides) {
    std::atomic<bool> any{false};
    core::worker_ranges(sides.points(), 1 << 16, [&](std::size_t begin, std::size_t end) {
        unsigned flags = 0;
        for (std::size_t point = begin; point < end; ++point) flags |= sides.flags()[point];
        if (flags & side::watched) any.store(true, std::memory_order_relaxed);
    });
    return any;
}

/// One call of extract_direct().
template <class Real>
class DirectRun {
public:
    DirectRun(const ops::DirectInput& input, const ops::DirectRequest& request)
        : input_(input), request_(request), wide_(input.grid.points.tuples() >= wide_points_from) {
        if (input.frame) mostly_negative_ = core::is_mostly_negative(*input.frame);
    }

    Result<ops::DirectResult> run(const Progress& progress) {
        try {
            return run_on_these_cells(progress);
        } catch (const NeedsAllCells&) {
            ops::DirectResult needs_all;
            needs_all.needs_all_cells = true;
            return needs_all;
        }
    }

private:
    Result<ops::DirectResult> run_on_these_cells(const Progress& progress) {
        if (auto ok = require_if_much("extraction", std::bit_ceil(input_.grid.points.tuples())); !ok) return ok.error();
        sides_ = Sides(input_.grid.points.tuples());
        if (auto ok = request_.isovalues.empty() ? look_only(progress) : extract_all(progress); !ok) return ok.error();
        if (auto ok = require_fit(); !ok) return ok.error();
        result_.origin = survey_.origin;
        result_.field = survey_.report(input_.field.name);
        for (const StoredField& field : survey_.carried) result_.carried.push_back(field.storage);
        return std::move(result_);
    }

    void require_all_cells() const {
        if (request_.active_cells_only) throw NeedsAllCells{};
    }

    /// No isovalue: what is told of cells and field.
    Result<void> look_only(const Progress& progress) {
        if (auto ok = core::check_cells(input_.grid, input_.cells, progress); !ok) return ok.error();
        if (auto ok = require_a_tet(); !ok) return ok.error();
        if (request_.active_cells_only) survey_as_assumed();
        else survey_used_points();
        for (std::size_t cell = 0; cell < input_.cells.count(); ++cell)
            result_.cells_left_out += !core::is_contoured(input_.cells.type(cell));
        return {};
    }

    Result<void> extract_all(const Progress& progress) {
        survey_ = survey_points<Real>(input_, nullptr);
        const std::size_t count = request_.isovalues.size();
        const auto share = [&](std::size_t done) {
            return 0.8 * static_cast<double>(done) / static_cast<double>(count);
        };
        for (std::size_t i = 0; i < count; ++i) {
            const Progress part = part_of(progress, share(i), share(i + 1));
            std::optional<ops::DirectSurface> surface;
            while (!surface) { // again when what was assumed turned out wrong: each assumption once
                auto tried = wide_ ? extract<std::uint64_t>(request_.isovalues[i], part)
                                   : extract<std::uint32_t>(request_.isovalues[i], part);
                if (!tried) return tried.error();
                surface = *std::move(tried);
            }
            result_.surfaces.push_back(*std::move(surface));
        }
        return {};
    }

    /// The surface; nothing when an assumption was wrong, which has then been set right.
    template <class Point>
    Result<std::optional<ops::DirectSurface>> extract(double isovalue, const Progress& progress) {
        const core::StoredIsovalue<Real> stored = core::store_isovalue<Real>(isovalue, survey_.field.storage);
        const SidesFound found = find_sides(input_, survey_, isovalue, stored, request_.ties,
                                            settled_ ? Watch::nothing : Watch::deciding, sides_);
        CutContext context{input_, sides_, Ranges(sides_.points())};
        context.mostly_negative = mostly_negative_.value_or(false);
        context.rounds_coordinates = survey_.rounds_coordinates;
        context.origin = survey_.origin;
        context.keep_cells = request_.source_cells;
        context.split_cells = request_.split_cells;
        auto cut = try_to_cut<Point>(context, part_of(progress, 0, 0.5));
        if (!cut) return cut.error();
        if (!is_as_assumed(context)) return std::optional<ops::DirectSurface>{};
        const CutCounts counts = cut->counts();
        if (counts.edges >= wide_points_from && !wide_) {
            wide_ = true;
            return std::optional<ops::DirectSurface>{};
        }
        result_.cells_left_out = counts.left_out;
        if (counts.triangles == 0)
            if (auto ok = require_a_tet(); !ok) return ok.error();

        auto surface = make_surface(VertexSource<Real>(input_, survey_, stored), *std::move(cut), context, progress);
        if (!surface) return surface.error();
        surface->coarse_tets = counts.coarse_tets;
        report_ties(input_, survey_, isovalue, stored, found, sides_, *surface);
        return std::optional(*std::move(surface));
    }

    template <class Point>
    Result<CutCells<Point>> try_to_cut(CutContext& context, const Progress& progress) {
        try {
            CutCells<Point> cut = cut_cells<Point>(context, progress);
            if (progress.cancelled()) return cancelled();
            if (!context.broken) return cut;
        } catch (const Budget::Exceeded&) {
            const std::uint64_t tets = count_cut_tets(input_.cells, sides_);
            const std::uint64_t most =
                tets * (24 + 4 * (sizeof(ActiveEdge<Point>) + sizeof(FoundEdge<Point>) + 3 * sizeof(Real)));
            return Error{ErrorCode::out_of_memory,
                         fmt::format("extraction may need {} for {} active tets, but {} are free",
                                     core::format_bytes(most), tets, core::format_bytes(context.budget.free()))};
        }
        if (auto sound = core::check_cells(input_.grid, input_.cells, progress); !sound) return sound.error();
        return Error{ErrorCode::internal, "extraction found a broken cell that the check of cells does not find"};
    }

    template <class Point>
    Result<ops::DirectSurface> make_surface(const VertexSource<Real>& source, CutCells<Point> cut,
                                            const CutContext& context, const Progress& progress) {
        const CutCounts counts = cut.counts();
        EmitOptions options{request_.ends || request_.normals, request_.source_cells, counts.edges >= wide_from,
                            &request_.slots, result_.surfaces.size()};
        const std::uint64_t needed =
            welding_memory<Point>(counts.edges) +
            emitting_memory<Real, Point>(counts.edges, counts.triangles, counts.edges, options);
        if (auto ok = require_if_much("the surface", needed); !ok) return ok.error();
        const std::uint64_t welding = sides_.bytes() + context.budget.taken() + welding_memory<Point>(counts.edges);
        Welded<Point> welded = weld(cut, context.ranges);
        if (progress.cancelled()) return cancelled();
        progress("extract", 0.7);
        options.wide = welded.vertex_count() >= wide_from;
        const std::uint64_t emitting = sides_.bytes() + context.budget.taken() + welding_memory<Point>(counts.edges) +
                                       counts.edges * (options.wide ? 8 : 4);
        result_.transient_bytes = std::max({result_.transient_bytes, welding, emitting});
        result_.predicted_bytes =
            std::max(result_.predicted_bytes, welding + needed - welding_memory<Point>(counts.edges));

        ops::DirectSurface out;
        auto surface = emit(source, cut, std::move(welded), options, progress);
        if (!surface) return surface.error();
        out.raw = *std::move(surface);
        cut = {};
        if (!request_.normals) return out;
        const core::ArraySlot slot = core::slot_of(request_.slots, result_.surfaces.size(), SurfaceArray::normals);
        auto normals = gradient_normals(
            source, sides_, mostly_negative_, [this] { return ask_for_most(); }, out.raw, slot, progress);
        if (!normals) return normals.error();
        out.raw.normals = *std::move(normals);
        if (!request_.ends) out.raw.ends = out.raw.weights = {};
        return out;
    }

    /// The survey of all points, where those that decide are used: active filters keep a cell of each.
    void survey_as_assumed() {
        survey_ = survey_points<Real>(input_, nullptr);
        find_sides(input_, survey_, 0, core::store_isovalue<Real>(0, survey_.field.storage), request_.ties,
                   Watch::deciding, sides_);
        see_used_points(input_.cells, request_.split_cells, sides_);
        if (!is_survey_of_used()) survey_used_points();
    }

    /// Whether points that were not seen decide on nothing.
    bool is_survey_of_used() {
        settled_ = true;
        if (!any_unseen(sides_)) return true;
        PointSurvey without_them = survey_points<Real>(input_, &sides_);
        if (!without_them.decides_as(survey_)) return false;
        survey_ = std::move(without_them);
        return true;
    }

    bool is_as_assumed(const CutContext& context) {
        if (!settled_ && !is_survey_of_used()) {
            survey_used_points();
            return false;
        }
        return !(context.saw_flat && !mostly_negative_ && ask_for_most());
    }

    /// Whether most tetrahedra are negative; asked once.
    bool ask_for_most() {
        require_all_cells();
        mostly_negative_ = core::survey_tets(input_.grid, input_.cells).mostly_negative();
        return *mostly_negative_;
    }

    /// The survey of just the points that tets use.
    void survey_used_points() {
        require_all_cells();
        std::fill(sides_.flags().begin(), sides_.flags().end(), side::watched);
        see_used_points(input_.cells, request_.split_cells, sides_);
        survey_ = survey_points<Real>(input_, &sides_);
        settled_ = true;
    }

    /// The survey is that of the used points by now.
    Result<void> require_fit() const {
        if (!input_.frame) return {};
        if (survey_.rounds_coordinates)
            if (auto ok = core::check_bounds(*input_.frame, survey_.lower, survey_.upper); !ok) return ok;
        return core::check_range(*input_.frame->find(input_.field.name), input_.field.name, survey_.field.statistics);
    }

    Result<void> require_a_tet() const {
        if (input_.frame) return {}; // a piece may be empty
        for (std::size_t cell = 0; cell < input_.cells.count(); ++cell)
            if (input_.cells.tets(cell).count) return {};
        require_all_cells();
        return core::nothing_to_contour(input_.grid, input_.cells);
    }

    const ops::DirectInput& input_;
    const ops::DirectRequest& request_;
    Sides sides_;
    PointSurvey survey_;
    bool settled_ = false;                ///< the survey is that of the points that tets use, not only of all points
    std::optional<bool> mostly_negative_; ///< nothing: never asked, and assumed not to be
    bool wide_;                           ///< point numbers
    ops::DirectResult result_;
};

} // namespace
} // namespace isotet::cpu::direct

namespace isotet::cpu {

template <class Real>
Result<ops::DirectResult> extract_direct(const ops::DirectInput& input, const ops::DirectRequest& request,
                                         const Progress& progress) {
    return direct::DirectRun<Real>(input, request).run(progress);
}

template Result<ops::DirectResult> extract_direct<float>(const ops::DirectInput&, const ops::DirectRequest&,
                                                         const Progress&);
template Result<ops::DirectResult> extract_direct<double>(const ops::DirectInput&, const ops::DirectRequest&,
                                                          const Progress&);

} // namespace isotet::cpu
