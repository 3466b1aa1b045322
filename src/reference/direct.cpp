// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "reference/direct.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "grid/cell/native_cells.hpp"
#include "grid/orientation.hpp"
#include "numbers/arithmetic.hpp"
#include "numbers/bounds.hpp"
#include "numbers/storage.hpp"
#include "numbers/sum_of_terms.hpp"
#include "numbers/tet_gradient.hpp"
#include "packed/frame.hpp"
#include "reference/triangles.hpp"

namespace isotet::reference {

namespace {

using core::Point;
using core::PointReader;

/// A tet in its stored form.
struct UserTet {
    core::Tet corners;
    std::size_t cell;
};

/// A tet or another cell in its stored form.
struct UserCell {
    core::CellKind kind;
    std::vector<std::uint64_t> corners;
    std::size_t cell;
};

bool mostly_negative(const ops::DirectInput& input) {
    if (input.frame) return core::is_mostly_negative(*input.frame);
    const PointReader points(input.grid.points);
    const core::CellReader& cells = input.cells;
    std::int64_t balance = 0;
    for (std::size_t cell = 0; cell < cells.count(); ++cell)
        if (cells.type(cell) == static_cast<std::uint8_t>(CellType::tetrahedron))
            for (const core::Tet& tet : cells.tets(cell)) balance += points.orientation(tet);
    return balance < 0;
}

std::vector<UserCell> native_cells(const ops::DirectInput& input) {
    const core::CellReader& cells = input.cells;
    const PointReader points(input.grid.points);
    const core::Orienter orienter(input.grid.points, mostly_negative(input));
    core::Orienter::Counts counts;
    std::vector<UserCell> out;
    for (std::size_t cell = 0; cell < cells.count(); ++cell) {
        if (!core::is_contoured(cells.type(cell))) continue;
        for (core::WholeCell part : core::native_parts(cells.whole(cell))) {
            if (part.kind == core::CellKind::tetrahedron) {
                const core::Tet tet{part.corners[0], part.corners[1], part.corners[2], part.corners[3]};
                const core::Tet stored = orienter.stored(cells.type(cell), cells.tets(cell), tet, counts);
                out.push_back({part.kind, {stored.begin(), stored.end()}, cell});
                continue;
            }
            if (!core::is_ordered(cells.type(cell)) &&
                core::turn_of(part, [&](std::size_t k) { return points[part.corners[k]]; }).is_mirrored())
                part.corners = core::mirrored(part.kind, part.corners);
            out.push_back(
                {part.kind, {part.corners.begin(), part.corners.begin() + core::corner_count(part.kind)}, cell});
        }
    }
    return out;
}

std::vector<UserCell> as_cells(const std::vector<UserTet>& tets) {
    std::vector<UserCell> out;
    for (const UserTet& tet : tets)
        out.push_back({core::CellKind::tetrahedron, {tet.corners.begin(), tet.corners.end()}, tet.cell});
    return out;
}

std::vector<UserTet> all_tets(const ops::DirectInput& input) {
    const core::CellReader& cells = input.cells;
    const core::Orienter orienter(input.grid.points, mostly_negative(input));
    std::vector<UserTet> tets;
    core::Orienter::Counts counts;
    for (std::size_t cell = 0; cell < cells.count(); ++cell) {
        const core::CellTets pieces = cells.tets(cell);
        for (int piece = 0; piece < pieces.count; ++piece)
            tets.push_back({orienter.stored(cells.type(cell), pieces, static_cast<unsigned>(piece), counts), cell});
    }
    return tets;
}

/// How a field is stored, from its values at the used points.
struct Looked {
    core::ValueStatistics statistics;
    core::Storage storage;
};

/// `framed`   null, or what a frame knows of the field
Looked look_at(const Array& values, const std::set<std::uint64_t>& used, Precision precision,
               const FieldSurvey* framed) {
    Looked out;
    const auto for_values = [&](const auto& f) {
        for (const std::uint64_t point : used)
            for (std::size_t k = 0; k < values.components(); ++k) f(values.at(point, k));
    };
    for_values([&](double value) { out.statistics.add(value); });
    if (framed && framed->type == values.type() && core::check_range(*framed, "", out.statistics)) {
        out.storage = core::storage_in(*framed, precision);
        return out;
    }
    out.storage = core::choose_offset(values.type(), out.statistics, precision);
    double smallest = std::numeric_limits<double>::infinity(), largest = 0;
    for_values([&](double value) {
        const double magnitude = std::abs(value - out.storage.offset);
        if (!(magnitude > 0) || std::isinf(magnitude)) return;
        smallest = std::min(smallest, magnitude);
        largest = std::max(largest, magnitude);
    });
    core::choose_scale(out.storage, smallest, largest);
    return out;
}

FieldReport report_on(const PointField& field, const Looked& looked) {
    FieldReport report;
    report.name = field.name;
    report.lower = looked.statistics.lower;
    report.upper = looked.statistics.upper;
    report.no_data = looked.statistics.no_data;
    report.infinite = looked.statistics.infinite;
    report.offset = looked.storage.offset;
    report.scale = looked.storage.scale;
    report.unchanged = looked.storage.unchanged;
    return report;
}

std::array<double, 3> origin_of(const PointReader& points, const std::set<std::uint64_t>& used) {
    std::array<double, 3> origin{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        double lower = std::numeric_limits<double>::infinity(), upper = -lower;
        for (const std::uint64_t point : used) {
            lower = std::min(lower, points[point][axis]);
            upper = std::max(upper, points[point][axis]);
        }
        origin[axis] = core::rounded_to_float(lower + (upper - lower) / 2);
    }
    return origin;
}

/// A grid with everything stored: what surfaces are made from.
template <class Real>
class StoredGrid {
public:
    StoredGrid(const ops::DirectInput& input, bool split_cells, ops::DirectResult& result)
        : tets_(all_tets(input)),
          cells_(split_cells ? as_cells(tets_) : native_cells(input)),
          field_(input.field.values),
          points_(input.grid.points) {
        for (const UserCell& cell : cells_) used_.insert(cell.corners.begin(), cell.corners.end());
        const Precision precision = sizeof(Real) == sizeof(float) ? Precision::float32 : Precision::float64;
        const auto in_frame = [&](const std::string& name) { return input.frame ? input.frame->find(name) : nullptr; };
        const Looked looked = look_at(field_, used_, precision, in_frame(input.field.name));
        storage_ = looked.storage;
        result.field = report_on(input.field, looked);
        for (const Field& field : input.carried)
            result.carried.push_back(look_at(field.values, used_, precision, in_frame(field.name)).storage);
        rounds_ = input.grid.points.type() == ScalarType::float64 && precision == Precision::float32;
        if (rounds_) origin_ = input.frame ? core::origin_in(input.frame->whole) : origin_of(points_, used_);
        result.origin = origin_;
        is_piece_ = input.frame != nullptr;
        for (const std::uint64_t point : used_) {
            values_[point] = core::store_value<Real>(field_.at(point), storage_);
            result.field.flushed += values_[point] == 0 && field_.at(point) != storage_.offset;
        }
    }

    /// Errors   invalid_argument when the frame does not hold the field or the points
    Result<void> check_fit(const ops::DirectInput& input) const;
    ops::DirectSurface extract(double isovalue, const ops::DirectRequest& request);

private:
    /// The user's points of an edge, lower first; twice the same for a tied point.
    using Edge = std::pair<std::uint64_t, std::uint64_t>;

    bool is_valid(const auto& cell) const {
        return std::none_of(cell.corners.begin(), cell.corners.end(),
                            [&](std::uint64_t p) { return core::is_nan(values_.at(p)); });
    }
    core::Vector<Real> position(std::uint64_t point) const {
        const Point p = points_[point];
        core::Vector<Real> stored;
        for (std::size_t axis = 0; axis < 3; ++axis)
            stored[axis] = core::store_coordinate<Real>(p[axis], origin_[axis]);
        return stored;
    }
    bool is_coarse(const UserCell& cell) const;
    void report_ties(double isovalue, const core::StoredIsovalue<Real>& stored, ops::DirectSurface& surface) const;
    std::map<std::uint64_t, std::uint32_t> gradients() const;

    std::vector<UserTet> tets_;
    std::vector<UserCell> cells_; ///< of which surfaces are made
    Array field_;
    PointReader points_;
    std::set<std::uint64_t> used_;
    core::Storage storage_;
    bool rounds_ = false; ///< coordinates
    bool is_piece_ = false;
    std::array<double, 3> origin_{};
    std::map<std::uint64_t, Real> values_; ///< stored ones, of the used points
};

template <class Real>
Result<void> StoredGrid<Real>::check_fit(const ops::DirectInput& input) const {
    if (!input.frame) return {};
    core::Bounds bounds;
    core::ValueStatistics statistics;
    for (const std::uint64_t point : used_) {
        bounds.add(points_[point]);
        statistics.add(field_.at(point));
    }
    if (rounds_)
        if (auto ok = core::check_bounds(*input.frame, bounds.lower, bounds.upper); !ok) return ok;
    return core::check_range(*input.frame->find(input.field.name), input.field.name, statistics);
}

template <class Real>
bool StoredGrid<Real>::is_coarse(const UserCell& cell) const {
    if (!rounds_) return false;
    double moved = 0, shortest = std::numeric_limits<double>::infinity();
    for (const std::uint64_t corner : cell.corners) {
        Point back;
        const core::Vector<Real> stored = position(corner);
        for (std::size_t axis = 0; axis < 3; ++axis) back[axis] = stored[axis] + origin_[axis];
        moved = std::max(moved, core::squared_distance(points_[corner], back));
    }
    for (const auto& [k, l] : core::edges_of(cell.kind))
        if (const std::uint64_t a = cell.corners[k], b = cell.corners[l]; a != b)
            shortest = std::min(shortest, core::squared_distance(points_[a], points_[b]));
    return moved > 1e-6 * shortest;
}

template <class Real>
void StoredGrid<Real>::report_ties(double isovalue, const core::StoredIsovalue<Real>& stored,
                                   ops::DirectSurface& surface) const {
    const auto holds_exactly = [&](std::uint64_t point, double value) {
        return field_.visit([&](auto values) { return core::equals_exactly(values[point], value); });
    };
    surface.isovalue_stored = core::restore_value(stored.sum(), storage_);
    for (const std::uint64_t point : used_)
        if (values_.at(point) == stored.tied) {
            ++surface.raw.tied_points;
            surface.false_ties += !holds_exactly(point, isovalue);
        }
    const double nearest = snap(field_, isovalue);
    if (nearest == isovalue || surface.raw.tied_points != 0) return;
    for (const std::uint64_t point : used_) surface.near_tie |= holds_exactly(point, nearest);
}

template <class Real>
std::map<std::uint64_t, std::uint32_t> StoredGrid<Real>::gradients() const {
    std::map<std::uint64_t, Point> sums;
    std::map<std::uint64_t, std::vector<Point>> terms;
    for (const UserTet& tet : tets_) {
        if (!is_valid(tet)) continue;
        std::array<Point, 4> corners;
        std::array<double, 4> values;
        for (std::size_t k = 0; k < 4; ++k) {
            const core::Vector<Real> p = position(tet.corners[k]);
            corners[k] = {p[0], p[1], p[2]};
            values[k] = values_.at(tet.corners[k]);
        }
        const Point gradient = core::six_volumes_times_gradient(corners, values);
        for (const std::uint64_t corner : tet.corners) {
            terms[corner].push_back(gradient);
            for (std::size_t axis = 0; axis < 3; ++axis) sums[corner][axis] += gradient[axis];
        }
    }
    if (is_piece_)
        for (auto& [point, list] : terms) sums[point] = core::sum_of_terms(list);
    std::map<std::uint64_t, std::uint32_t> codes;
    for (const auto& [point, sum] : sums) codes[point] = core::encode_normal(sum);
    return codes;
}

template <class Real>
ops::DirectSurface StoredGrid<Real>::extract(double user_isovalue, const ops::DirectRequest& request) {
    const core::StoredIsovalue<Real> isovalue = core::store_isovalue<Real>(user_isovalue, storage_);
    const auto value = [&](std::uint64_t p) { return values_.at(p); };
    const auto edge_of = [&](std::uint64_t above, std::uint64_t below) -> Edge {
        if (request.ties == Ties::merge && value(above) == isovalue.tied) return {above, above};
        return {std::min(above, below), std::max(above, below)};
    };
    ops::DirectSurface surface;
    std::vector<std::array<Edge, 3>> triangles;
    std::vector<std::int64_t> source_cells;
    std::map<Edge, std::uint64_t> numbers;
    for (const UserCell& cell : cells_) {
        if (!is_valid(cell)) continue;
        unsigned index = 0;
        for (std::size_t k = 0; k < cell.corners.size(); ++k)
            index |= unsigned{value(cell.corners[k]) >= isovalue.value} << k;
        const std::size_t before = triangles.size();
        for (const auto& edges : triangles_of(cell.kind, index)) {
            std::array<Edge, 3> triangle;
            for (std::size_t k = 0; k < 3; ++k)
                triangle[k] = edge_of(cell.corners[edges[k].above], cell.corners[edges[k].below]);
            if (triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0]) continue;
            triangles.push_back(triangle);
            for (const Edge& edge : triangle) numbers[edge] = 0;
            if (request.source_cells) source_cells.push_back(static_cast<std::int64_t>(cell.cell));
        }
        surface.coarse_tets += triangles.size() > before && is_coarse(cell);
    }

    const auto codes = request.normals ? gradients() : std::map<std::uint64_t, std::uint32_t>{};
    const auto code_of = [&](std::uint64_t point) {
        const auto found = codes.find(point); // a corner of a collapsed cell may have no tet
        return found == codes.end() ? core::encode_normal(Point{}) : found->second;
    };
    std::vector<Real> positions, weights;
    std::vector<float> normals;
    std::vector<std::int64_t> ends;
    std::uint64_t next = 0;
    for (auto& [edge, number] : numbers) {
        number = next++;
        const bool lower_is_above = value(edge.first) >= isovalue.value;
        const std::uint64_t below = lower_is_above ? edge.second : edge.first,
                            above = lower_is_above ? edge.first : edge.second;
        const Real t = below == above ? Real(0) : core::edge_weight(isovalue, value(below), value(above));
        const core::Vector<Real> a = position(below), b = position(above);
        for (std::size_t axis = 0; axis < 3; ++axis) positions.push_back(core::interpolate(a[axis], b[axis], t));
        if (request.ends) {
            ends.push_back(static_cast<std::int64_t>(below));
            ends.push_back(static_cast<std::int64_t>(above));
            weights.push_back(t);
        }
        if (request.normals)
            for (const Real x : core::vertex_normal(code_of(below), code_of(above), t))
                normals.push_back(static_cast<float>(x));
    }

    ops::RawSurface& raw = surface.raw;
    const auto number_triangles = [&]<class Index>(std::vector<Index> out) {
        for (const auto& triangle : triangles)
            for (const Edge& edge : triangle) out.push_back(static_cast<Index>(numbers.at(edge)));
        raw.triangles = Array::own(std::move(out), 3);
    };
    if (numbers.size() < std::uint64_t{1} << 32) number_triangles(std::vector<std::uint32_t>{});
    else number_triangles(std::vector<std::uint64_t>{});
    raw.positions = Array::own(std::move(positions), 3);
    if (request.ends) {
        raw.ends = Array::own(std::move(ends), 2);
        raw.weights = Array::own(std::move(weights));
    }
    if (request.normals) raw.normals = Array::own(std::move(normals), 3);
    if (request.source_cells) raw.source_cells = Array::own(std::move(source_cells));
    report_ties(user_isovalue, isovalue, surface);
    return surface;
}

} // namespace

template <class Real>
Result<ops::DirectResult> extract_direct(const ops::DirectInput& input, const ops::DirectRequest& request,
                                         const Progress& progress) {
    if (auto ok = core::check_cells(input.grid, input.cells, progress); !ok) return ok.error();
    if (!input.frame && all_tets(input).empty()) return core::nothing_to_contour(input.grid, input.cells);
    ops::DirectResult result;
    for (std::size_t cell = 0; cell < input.cells.count(); ++cell)
        result.cells_left_out += !core::is_contoured(input.cells.type(cell));
    StoredGrid<Real> stored(input, request.split_cells, result);
    if (auto ok = stored.check_fit(input); !ok) return ok.error();
    for (const double isovalue : request.isovalues) {
        if (progress.cancelled()) return Error{ErrorCode::cancelled, "extraction was cancelled"};
        result.surfaces.push_back(stored.extract(isovalue, request));
    }
    return result;
}

template Result<ops::DirectResult> extract_direct<float>(const ops::DirectInput&, const ops::DirectRequest&,
                                                         const Progress&);
template Result<ops::DirectResult> extract_direct<double>(const ops::DirectInput&, const ops::DirectRequest&,
                                                          const Progress&);

} // namespace isotet::reference
