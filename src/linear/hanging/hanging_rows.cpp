// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "linear/hanging/hanging_rows.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <mutex>
#include <span>
#include <tuple>
#include <utility>

#include "base/buffer.hpp"
#include "base/parallel.hpp"
#include "base/radix_sort.hpp"
#include "linear/hanging/face_place.hpp"
#include "linear/vector.hpp"

namespace isotet::linear {

namespace {

constexpr double in_place = 1e-5;     // of a face's longest edge: a point of a straight face or edge
constexpr double roundings = 0x1p-21; // of the largest coordinate, of points in single precision
constexpr int max_chain = 64;         // hanging points that are made of hanging points

/// A point on an edge or a face.
struct HangingRow {
    std::uint64_t point = 0;
    bool on_face = false;  ///< and not on an edge of it
    double size = 0;       ///< of the edge or face, squared
    std::size_t count = 0; ///< of corners
    std::array<std::uint64_t, 4> corners{};
    std::array<double, 4> weights{};

    std::span<const std::uint64_t> all_corners() const { return {corners.data(), count}; }

    /// A point has the row that comes first: of an edge, of the longest one.
    bool comes_before(const HangingRow& other) const {
        return std::tie(on_face, other.size, corners) < std::tie(other.on_face, size, other.corners);
    }
};

HangingRow row_of(std::uint64_t point, std::span<const std::uint64_t> loop, const FacePlace& at) {
    HangingRow row;
    row.point = point;
    row.count = at.count;
    row.weights = at.weights;
    for (std::size_t i = 0; i < at.count; ++i) row.corners[i] = loop[at.corners[i]];
    return row;
}

class HangingRowMaker {
public:
    HangingRowMaker(const OpenFaces& open, const Covers& covers, const core::PointReader& points)
        : open_(open), covers_(covers), points_(points) {}

    /// By ascending point, each once.
    std::vector<HangingRow> make() {
        std::vector<HangingRow> rows = rows_of_covers();
        rows.reserve(rows.size() + covers_.edges.size());
        for (std::size_t i = 0; i < covers_.edges.size(); ++i) rows.push_back(row_on_edge(covers_.edges[i]));
        core::Buffer<core::Keyed> items(rows.size()), scratch(rows.size());
        for (std::size_t i = 0; i < rows.size(); ++i) items[i] = {rows[i].point, i};
        core::radix_sort({items.data(), items.size()}, {scratch.data(), scratch.size()});
        std::vector<HangingRow> out;
        for (const core::Keyed& item : items)
            if (const HangingRow& row = rows[item.number]; out.empty() || out.back().point != row.point)
                out.push_back(row);
            else if (row.comes_before(out.back()))
                out.back() = row;
        return out;
    }

    /// By cover: the largest distance of its points from its face.
    const std::vector<double>& distances() const { return distances_; }

private:
    std::vector<HangingRow> rows_of_covers() {
        distances_.resize(covers_.whole.size());
        std::vector<HangingRow> rows;
        std::mutex mutex;
        core::parallel_ranges(distances_.size(), 1 << 9, [&](std::size_t begin, std::size_t end) {
            std::vector<HangingRow> part;
            std::vector<std::uint64_t> points;
            for (std::size_t i = begin; i < end; ++i) {
                find_points(covers_.whole[i], points);
                distances_[i] = add(covers_.whole[i], points, part);
            }
            const std::lock_guard lock(mutex);
            rows.insert(rows.end(), part.begin(), part.end());
        });
        return rows;
    }

    /// Those that the covering faces have, and the covered one has not, ascending.
    void find_points(const Cover& cover, std::vector<std::uint64_t>& out) const {
        const auto corners = open_.loop(cover.face);
        out.clear();
        for (const Cover::Part& part : cover.by)
            for (const std::uint64_t point : open_.loop(part.face))
                if (std::ranges::find(corners, point) == corners.end()) out.push_back(point);
        std::ranges::sort(out);
        out.erase(std::unique(out.begin(), out.end()), out.end());
    }

    /// Rows of the points that are on no edge of the face. Returns the largest distance of all, but for points that are
    /// on its edges to rounding.
    double add(const Cover& cover, const std::vector<std::uint64_t>& points, std::vector<HangingRow>& rows) const {
        const auto loop = open_.loop(cover.face);
        double farthest = 0;
        for (const std::uint64_t point : points) {
            const auto on = std::ranges::find(cover.between, point, &Cover::OnEdge::point);
            if (on != cover.between.end() && is_on_edge(loop, *on)) continue;
            const FacePlace at = place_on_face(loop, points_[point], points_);
            farthest = std::max(farthest, at.distance);
            if (on != cover.between.end()) continue;
            rows.push_back(row_of(point, loop, at));
            rows.back().on_face = true;
            rows.back().size = core::squared_distance(points_[loop[0]], points_[loop[loop.size() / 2]]);
        }
        return farthest;
    }

    bool is_on_edge(std::span<const std::uint64_t> loop, const Cover::OnEdge& on) const {
        const Point from = points_[loop[on.edge]], to = points_[loop[(on.edge + 1) % loop.size()]];
        const double distance = place_on_edge(from, to, points_[on.point]).distance;
        return distance * distance <= in_place * in_place * core::squared_distance(from, to);
    }

    HangingRow row_on_edge(const PointOnEdge& on) const {
        const std::array ends{on.low, on.high};
        HangingRow row = row_of(on.point, ends, place_on_edge(points_[on.low], points_[on.high], points_[on.point]));
        row.size = core::squared_distance(points_[on.low], points_[on.high]);
        return row;
    }

    const OpenFaces& open_;
    const Covers& covers_;
    const core::PointReader& points_;
    std::vector<double> distances_;
};

/// The rows in an order in which those whose corners hang come after these; else by point.
/// `points`   of the grid
std::vector<std::uint32_t> ordered(const std::vector<HangingRow>& rows, std::uint64_t points) {
    constexpr auto none = std::numeric_limits<std::uint32_t>::max();
    std::vector<std::uint32_t> row_at(points, none);
    for (std::size_t i = 0; i < rows.size(); ++i) row_at[rows[i].point] = static_cast<std::uint32_t>(i);
    std::vector<int> depths(rows.size(), 0);
    int deepest = 0;
    bool deeper = true;
    for (int pass = 0; deeper && pass < max_chain; ++pass) {
        deeper = false;
        for (std::size_t i = 0; i < rows.size(); ++i)
            for (const std::uint64_t corner : rows[i].all_corners()) {
                const std::uint32_t parent = row_at[corner];
                if (parent == none || depths[parent] < depths[i]) continue;
                deepest = std::max(deepest, depths[i] = depths[parent] + 1);
                deeper = true;
            }
    }
    std::vector<std::uint32_t> out;
    out.reserve(rows.size());
    for (int depth = 0; depth <= deepest; ++depth)
        for (std::size_t i = 0; i < rows.size(); ++i)
            if (depths[i] == depth) out.push_back(static_cast<std::uint32_t>(i));
    return out;
}

void put_rows(const std::vector<HangingRow>& rows, const std::vector<std::uint32_t>& order, ClosedGrid& out) {
    std::size_t terms = 0;
    for (const HangingRow& row : rows) terms += row.count;
    core::Buffer<std::uint64_t> points(rows.size()), first(rows.size() + 1), corners(terms);
    core::Buffer<double> weights(terms);
    first[0] = 0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const HangingRow& row = rows[order[i]];
        points[i] = row.point;
        std::copy_n(row.corners.begin(), row.count, corners.begin() + first[i]);
        std::copy_n(row.weights.begin(), row.count, weights.begin() + first[i]);
        first[i + 1] = first[i] + row.count;
    }
    out.points = std::move(points).to_array();
    out.parents = {std::move(first).to_array(), std::move(corners).to_array(), std::move(weights).to_array()};
}

/// The most points on one edge of a covered face.
std::uint64_t most_between(const Cover& cover) {
    std::uint64_t most = 0;
    for (auto on = cover.between.begin(); on != cover.between.end();) {
        const auto is_other = [&](const Cover::OnEdge& at) { return at.edge != on->edge; };
        const auto next = std::find_if(on, cover.between.end(), is_other);
        most = std::max(most, static_cast<std::uint64_t>(next - on));
        on = next;
    }
    return most;
}

} // namespace

void describe_hanging(const OpenFaces& open, const Covers& covers, const core::PointReader& points, bool single,
                      ClosedGrid& out) {
    HangingRowMaker maker(open, covers, points);
    const std::vector<HangingRow> rows = maker.make();
    put_rows(rows, ordered(rows, out.grid.points.tuples()), out);
    HangingReport& report = out.report;
    report.points = rows.size();
    report.faces = covers.whole.size();
    const std::vector<double>& distances = maker.distances();
    for (std::size_t i = 0; i < distances.size(); ++i) {
        const Cover& cover = covers.whole[i];
        const auto loop = open.loop(cover.face);
        double longest = 0, largest = 0;
        for (std::size_t k = 0; k < loop.size(); ++k) {
            longest = std::max(longest, core::squared_distance(points[loop[k]], points[loop[(k + 1) % loop.size()]]));
            for (const double x : points[loop[k]]) largest = std::max(largest, std::abs(x));
        }
        report.levels = std::max(report.levels, static_cast<std::uint64_t>(std::bit_width(most_between(cover))));
        const double tolerance = in_place * std::sqrt(longest) + (single ? roundings * largest : 0);
        if (!(distances[i] > tolerance)) continue;
        ++report.near_faces;
        report.largest_distance = std::max(report.largest_distance, distances[i]);
    }
    if (report.points > 0) report.levels = std::max<std::uint64_t>(report.levels, 1);
}

} // namespace isotet::linear
