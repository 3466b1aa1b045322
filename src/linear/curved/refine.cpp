// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/linear_cells.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>

#include "base/carry_out.hpp"
#include "base/errors.hpp"
#include "base/system/memory.hpp"
#include "base/parallel.hpp"
#include "linear/curved/bisection.hpp"
#include "linear/curved/folded_cells.hpp"
#include "linear/curved/own_pieces.hpp"
#include "linear/curved/refine.hpp"
#include "linear/weld.hpp"

namespace isotet {

namespace linear {

namespace {

constexpr std::uint64_t bytes_per_made_tet = 72; ///< with its share of points, while blocks are put together

Error refining_cancelled() { return {ErrorCode::cancelled, "refining was cancelled"}; }

/// Upper less lower end of the finite values at the nodes.
double range_of(const QuadraticTets& tets, const NodeValues& values) {
    double lower = std::numeric_limits<double>::infinity(), upper = -lower;
    for (const QuadraticTet& tet : tets.tets)
        for (const double value : values.of(tet)) {
            if (!std::isfinite(value)) continue;
            lower = std::min(lower, value);
            upper = std::max(upper, value);
        }
    return lower <= upper ? upper - lower : 0;
}

/// Components of carried fields, with the arrays that they borrow.
struct CarriedFields {
    std::vector<Array> arrays;
    std::vector<CarriedValues> values;
};

/// `known`   of all tets, where some of them are left; else empty
Result<CarriedFields> carried_at_nodes(const RefineOptions& options, const LinearGrid& before,
                                       const QuadraticTets& tets, const CarriedFields& known) {
    CarriedFields out;
    for (const Field& field : options.carried) {
        if (!is_floating(field.values.type())) continue;
        if (field.values.tuples() != before.user_points)
            return invalid_argument(fmt::format("the carried field '{}' has {} tuples, but there are {} points",
                                                field.name, field.values.tuples(), before.user_points));
        auto extended = before.extend(field.values);
        if (!extended) return extended.error();
        out.arrays.push_back(*std::move(extended));
        for (std::size_t k = 0; k < field.values.components(); ++k) {
            NodeValues values(out.arrays.back(), tets.hidden, k);
            const double allowed = known.arrays.empty()
                                       ? options.carried_tolerance * range_of(tets, values) / error_per_deviation
                                       : known.values[out.values.size()].deviation;
            out.values.push_back({std::move(values), allowed});
        }
    }
    return out;
}

Result<void> check_options(const RefineOptions& options) {
    for (const auto& [name, value] : {std::pair{"tolerance", options.tolerance},
                                      {"relative tolerance", options.relative_tolerance},
                                      {"distance", options.distance},
                                      {"tolerance of carried fields", options.carried_tolerance},
                                      {"geometry tolerance", options.geometry_tolerance}})
        if (!std::isfinite(value) || value < 0)
            return invalid_argument(fmt::format("the {} is {}, but must be finite and not negative", name, value));
    if (options.tolerance == 0 && options.relative_tolerance == 0 && options.distance == 0)
        return invalid_argument("tolerance, relative tolerance and distance are 0, but one must be above");
    for (const double isovalue : options.isovalues)
        if (!std::isfinite(isovalue))
            return invalid_argument(fmt::format("an isovalue is {}, but must be finite", isovalue));
    return {};
}

/// The blocks' reports together.
RefinementReport reported(const std::vector<Bisected>& blocks, const QuadraticTets& tets) {
    RefinementReport report;
    report.curved_cells = tets.curved;
    report.unknown_cells = tets.unknown;
    report.left_out = tets.left_out;
    report.quadratic_tets = tets.tets.size();
    double length2 = 0;
    DistanceCounts distances;
    for (const Bisected& block : blocks) {
        report.tets += block.tets.size();
        report.not_finite += block.not_finite;
        report.field_bound = std::max(report.field_bound, error_per_deviation * block.deviation);
        length2 = std::max(length2, block.length2);
        report.too_fine |= block.too_fine;
        distances.add(block.distances);
    }
    report.geometry_bound = error_per_deviation * std::sqrt(length2);
    report.largest_distance = distances.largest();
    report.distance = distances.not_exceeded_by(0.99);
    return report;
}

/// The difference of quadratic tets from the cells' own functions, of those of which something is kept.
void add_own_bounds(const std::vector<Bisected>& blocks, const OwnBounds& own, RefinementReport& report) {
    if (own.value.empty()) return;
    double value = 0, length = 0;
    std::size_t tet = 0;
    for (const Bisected& block : blocks)
        for (const std::uint32_t children : block.children) {
            if (children > 0) {
                value = std::max(value, own.value[tet]);
                length = std::max(length, own.length[tet]);
            }
            ++tet;
        }
    report.field_bound += value;
    report.geometry_bound += length;
}

/// Edges that bend too much are of cells that fold, or of sound ones that bend strongly: a look at some of them.
bool has_folds(const std::vector<Bisected>& blocks, const Grid& user, const LinearGrid& before,
               const QuadraticTets& tets, const std::array<NodeValues, 3>& points) {
    constexpr std::size_t most = 1000;
    std::vector<std::uint32_t> bent;
    for (const Bisected& block : blocks)
        for (const std::uint32_t tet : block.bent)
            if (bent.size() < most && (bent.empty() || tets.sources[bent.back()] != tets.sources[tet]))
                bent.push_back(tet);
    return folded_cells(user, before, tets, points, bent) > 0;
}

/// Where isovalues meet nothing, what the first quadratic tet becomes stays, where none has only finite values a part of the first
/// one without a surface: what contours takes no grid without cells.
void keep_one(std::vector<Bisected>& blocks, std::size_t count, std::size_t per_block, Bisector& bisector) {
    if (!std::ranges::all_of(blocks, [](const Bisected& block) { return block.tets.empty(); })) return;
    for (std::size_t b = 0; b < blocks.size(); ++b) {
        bool kept = false;
        for (std::size_t i = b * per_block; i < std::min(count, (b + 1) * per_block); ++i) {
            if (kept) bisector.pass_over();
            else kept = bisector.bisect(static_cast<std::uint32_t>(i)) > 0;
        }
        Bisected block = bisector.take();
        if (!kept) continue; // none of its nodes is finite
        block.not_finite = blocks[b].not_finite;
        blocks[b] = std::move(block);
        return;
    }
    if (count == 0) return;
    bisector.keep_whole(0);
    for (std::size_t i = 1; i < std::min(count, per_block); ++i) bisector.pass_over();
    Bisected block = bisector.take();
    block.not_finite = blocks[0].not_finite;
    blocks[0] = std::move(block);
}

} // namespace

Result<LinearGrid> refined(const Grid& user, LinearGrid before, const Array* field, const RefineOptions& options,
                           const Progress& progress) {
    auto tets = quadratic_tets(before.grid, field ? CellNodeLists::kept : CellNodeLists::left_out, progress);
    if (!tets) return tets.error();
    progress("refine", 0.1);
    std::array<NodeValues, 3> points;
    for (std::size_t k = 0; k < 3; ++k) points[k] = NodeValues(before.grid.points, tets->hidden, k);

    BisectionRule rule;
    rule.nodes_only = field == nullptr;
    rule.length = options.geometry_tolerance / error_per_deviation;
    std::vector<double> isovalues = options.isovalues;
    std::ranges::sort(isovalues);
    rule.isovalues = isovalues;
    Array longer;
    NodeValues values;
    std::vector<double> deviations;
    OwnBounds own;
    CarriedFields carried;
    double tolerance = 0;
    if (field) {
        auto extended = before.extend(*field);
        if (!extended) return extended.error();
        longer = *std::move(extended);
        values = NodeValues(longer, tets->hidden);
        const double range = range_of(*tets, values);
        tolerance = options.tolerance > 0 ? options.tolerance : options.relative_tolerance * range;
        constexpr double finest = 0x1p-44; // of the range: beyond, rounding is all that is left
        const double most_error = std::max(tolerance, finest * range);
        constexpr double share = 3.0 / 8, reserve = 1.0 / 2; // of the tolerance, for the cells' own functions
        OwnRule own_rule;
        own_rule.value = share * (tolerance > 0 ? most_error : RefineOptions().relative_tolerance * range);
        own_rule.length = share * options.geometry_tolerance;
        own_rule.isovalues = isovalues;
        auto fields = carried_at_nodes(options, before, *tets, {});
        if (!fields) return fields.error();
        carried = *std::move(fields);
        own_rule.carried = carried.values;
        auto found = follow_own_functions(user, before, *tets, values, points, own_rule, progress);
        if (!found) return found.error();
        own = *std::move(found);
        if (before.grid.points.tuples() != longer.tuples()) {
            extended = before.extend(*field);
            if (!extended) return extended.error();
            longer = *std::move(extended);
            values = NodeValues(longer, tets->hidden);
            for (std::size_t k = 0; k < 3; ++k) points[k] = NodeValues(before.grid.points, tets->hidden, k);
            fields = carried_at_nodes(options, before, *tets, carried);
            if (!fields) return fields.error();
            carried = *std::move(fields);
        }
        rule.carried = carried.values;
        rule.deviation =
            (most_error - std::min(own.expected * reserve / share, reserve * most_error)) / error_per_deviation;
        if (options.distance > 0) {
            constexpr double finest_for_distance = 1e-5; // of the range: where the field is flat, no distance is kept
            const double most = tolerance > 0 ? rule.deviation : std::numeric_limits<double>::infinity();
            const double least = std::min(most, finest_for_distance * range / error_per_deviation);
            deviations = deviations_for(options.distance, least, most, *tets, values, points, longer.tuples());
            rule.deviations = deviations;
        }
    }

    if (constexpr std::uint64_t most = std::numeric_limits<std::uint32_t>::max(); tets->tets.size() > most)
        return invalid_data(fmt::format("the cells are {} quadratic tets, but may be at most {} where cells are curved",
                                        tets->tets.size(), most));
    BisectionLimits limits;
    const std::uint64_t free = core::free_memory();
    limits.max_tets = free / bytes_per_made_tet;
    if (options.max_tets > 0) limits.max_tets = std::min(limits.max_tets, options.max_tets);
    const std::size_t count = tets->tets.size(), shares = 32 * static_cast<std::size_t>(core::threads_here()),
                      per_block = std::clamp<std::size_t>(count / shares, 1, 1U << 14U);
    std::vector<Bisected> blocks((count + per_block - 1) / per_block);
    tbb::enumerable_thread_specific<Bisector> bisectors(
        [&] { return Bisector(*tets, points, field ? &values : nullptr, rule, limits, progress); });
    core::parallel_pieces(blocks.size(), 1, progress, [&](std::size_t begin, std::size_t end) {
        Bisector& bisector = bisectors.local();
        for (std::size_t b = begin; b < end && !limits.exceeded; ++b) {
            for (std::size_t i = b * per_block; i < std::min(count, (b + 1) * per_block); ++i)
                bisector.bisect(static_cast<std::uint32_t>(i));
            blocks[b] = bisector.take();
        }
    });
    if (progress.cancelled()) return refining_cancelled();
    if (limits.exceeded)
        return Error{
            ErrorCode::out_of_memory,
            fmt::format("refining to {:g} makes over {} tets, the most that {} allow: a larger tolerance makes "
                        "fewer",
                        tolerance, limits.max_tets,
                        options.max_tets == limits.max_tets ? "the options" : format_bytes(free) + " of memory")};
    BisectionRule all = rule;
    all.isovalues = {};
    Bisector bisector(*tets, points, field ? &values : nullptr, all, limits, progress);
    keep_one(blocks, count, per_block, bisector);
    progress("refine", 0.6);
    RefinementReport report = reported(blocks, *tets);
    add_own_bounds(blocks, own, report);
    report.too_bent = has_folds(blocks, user, before, *tets, points);
    auto made = welded(blocks, *tets, before.grid.points.tuples(), progress);
    if (!made) return made.error();
    progress("refine", 0.9);
    LinearGrid& out = *made;
    report.curved_cells += before.report.high_degree - before.report.high_degree_parts; // the user's cells
    report.points = out.refined.count();
    report.refined = field != nullptr;
    report.tolerance = tolerance;
    report.wanted_distance = field ? options.distance : 0;
    report.isovalues = std::move(isovalues);
    out.refinement = std::move(report);
    out.user_points = before.user_points;
    out.user_cells = before.user_cells;
    out.derived = before.derived;
    out.report = before.report;
    if (!before.source_cells.empty()) {
        const auto users = before.source_cells.as<std::uint64_t>(), mine = out.source_cells.as<std::uint64_t>();
        std::vector<std::uint64_t> composed(mine.size());
        for (std::size_t i = 0; i < mine.size(); ++i) composed[i] = users[mine[i]];
        out.source_cells = Array::own(std::move(composed));
    }
    Array user_points = before.grid.points;
    if (before.derived.count() > 0)
        user_points = Array(user_points.type(), user_points.data(), before.user_points, 3,
                            std::make_shared<Array>(before.grid.points));
    auto placed = out.extend(user_points);
    if (!placed) return placed.error();
    out.grid.points = *std::move(placed);
    progress("refine", 1);
    return made;
}

} // namespace linear

Result<LinearGrid> refine(const Grid& grid, const PointField& field, const RefineOptions& options, const Run& run) {
    return core::carry_out("refining curved cells", run, [&](const Progress& progress) -> Result<LinearGrid> {
        if (auto sound = linear::check_options(options); !sound) return sound.error();
        if (field.values.components() != 1 || field.values.tuples() != grid.points.tuples())
            return invalid_argument(
                fmt::format("the field '{}' has {} tuples of {} components, but must have one scalar "
                            "for each of the {} points",
                            field.name, field.values.tuples(), field.values.components(), grid.points.tuples()));
        auto split = linear::split_polyhedra(grid, {}, progress);
        if (!split || !has_curved_cells(grid.cells)) return split;
        auto made = linear::refined(grid, *split, &field.values, options, progress);
        if (made || made.error().code != ErrorCode::out_of_memory || options.carried.empty()) return made;
        RefineOptions alone = options;
        alone.carried = {};
        made = linear::refined(grid, *std::move(split), &field.values, alone, progress);
        if (made) made->refinement.carried_left_out = true;
        return made;
    });
}

} // namespace isotet
