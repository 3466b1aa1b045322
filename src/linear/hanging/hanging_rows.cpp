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

#include <tbb/parallel_sort.h>

#include "base/buffer.hpp"
#include "base/parallel.hpp"
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
    bool on_face = false;     ///< and not on an edge of it
    double size = 0;          ///< of the edge or face, squared
    std::size_t count = 0;        ///< of corners
    std::array<std::uint64_t, 4> corners{};
    std::array<double, 4> weights{};
    int depth = 0;

    /// A point has the row that comes first: of an edge, of the longest one.
    bool comes_before(const HangingRow& other) const {
        return std::tie(point, on_face, other.size, corners) <
               std::tie(other.point, other.on_face, size, other.corners);
    }
};

class HangingRowMaker {
public:
    HangingRowMaker(const OpenFaces& open, const Covers& covers, const core::PointReader& points)
        : open_(open), covers_(covers), points_(points) {}

    std::vector<HangingRow> make() {
        std::vector<HangingRow> rows = rows_of_covers();
        for (const PointOnEdge& at : covers_.edges.all()) add_on_edge(at.low, at.high, at.point, rows);
        tbb::parallel_sort(rows.begin(), rows.end(),
                           [](const HangingRow& a, const HangingRow& b) { return a.comes_before(b); });
        const auto same = [](const HangingRow& a, const HangingRow& b) { return a.point == b.point; };
        rows.erase(std::unique(rows.begin(), rows.end(), same), rows.end());
        find_depths(rows);
        std::ranges::stable_sort(rows, {}, &HangingRow::depth);
        return rows;
    }

    /// By cover: the largest distance of its points from its face.
    const std::vector<double>& distances() const { return distances_; }

private:
    std::vector<std::uint64_t> points_of_cover(const Cover& cover) const {
        std::vector<std::uint64_t> out;
        for (const std::uint32_t other : cover.by) {
            const auto loop = open_.loop(other);
            out.insert(out.end(), loop.begin(), loop.end());
        }
        std::ranges::sort(out);
        out.erase(std::unique(out.begin(), out.end()), out.end());
        const auto loop = open_.loop(cover.face);
        std::erase_if(out, [&](std::uint64_t point) { return std::ranges::find(loop, point) != loop.end(); });
        return out;
    }

    std::vector<HangingRow> rows_of_covers() {
        distances_.resize(covers_.whole.size());
        std::vector<HangingRow> rows;
        std::mutex mutex;
        core::parallel_ranges(distances_.size(), 1 << 8, [&](std::size_t begin, std::size_t end) {
            std::vector<HangingRow> part;
            for (std::size_t i = begin; i < end; ++i) distances_[i] = add(covers_.whole[i], part);
            const std::lock_guard lock(mutex);
            rows.insert(rows.end(), part.begin(), part.end());
        });
        return rows;
    }

    /// Rows of the points that are on no edge of the face. Returns the largest distance of all.
    double add(const Cover& cover, std::vector<HangingRow>& rows) const {
        const auto loop = open_.loop(cover.face);
        double farthest = 0;
        for (const std::uint64_t point : points_of_cover(cover)) {
            const FacePlace at = place_on_face(loop, points_[point], points_);
            farthest = std::max(farthest, at.distance);
            const auto has = [&](const std::vector<std::uint64_t>& some) {
                return std::ranges::find(some, point) != some.end();
            };
            if (std::ranges::any_of(cover.between, has)) continue; // on an edge
            rows.push_back(row_of(point, loop, at));
            rows.back().on_face = true;
            rows.back().size = core::squared_distance(points_[loop[0]], points_[loop[loop.size() / 2]]);
        }
        return farthest;
    }

    static HangingRow row_of(std::uint64_t point, std::span<const std::uint64_t> loop, const FacePlace& at) {
        HangingRow row;
        row.point = point;
        row.count = at.count;
        row.weights = at.weights;
        for (std::size_t i = 0; i < at.count; ++i) row.corners[i] = loop[at.corners[i]];
        return row;
    }

    void add_on_edge(std::uint64_t low, std::uint64_t high, std::uint64_t point, std::vector<HangingRow>& rows) const {
        const std::array ends{low, high};
        rows.push_back(row_of(point, ends, place_on_edge(points_[low], points_[high], points_[point])));
        rows.back().size = core::squared_distance(points_[low], points_[high]);
    }

    /// Rows whose corners hang come after these.
    static void find_depths(std::vector<HangingRow>& rows) {
        bool deeper = true;
        for (int pass = 0; deeper && pass < max_chain; ++pass) {
            deeper = false;
            for (HangingRow& row : rows)
                for (const std::uint64_t corner : std::span(row.corners).first(row.count)) {
                    const auto parent = std::ranges::lower_bound(rows, corner, {}, &HangingRow::point);
                    if (parent == rows.end() || parent->point != corner || parent->depth < row.depth) continue;
                    row.depth = parent->depth + 1;
                    deeper = true;
                }
        }
    }

    const OpenFaces& open_;
    const Covers& covers_;
    const core::PointReader& points_;
    std::vector<double> distances_;
};

void put_rows(const std::vector<HangingRow>& rows, ClosedGrid& out) {
    std::size_t terms = 0;
    for (const HangingRow& row : rows) terms += row.count;
    core::Buffer<std::uint64_t> points(rows.size()), first(rows.size() + 1), corners(terms);
    core::Buffer<double> weights(terms);
    first[0] = 0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        points[i] = rows[i].point;
        std::copy_n(rows[i].corners.begin(), rows[i].count, corners.begin() + first[i]);
        std::copy_n(rows[i].weights.begin(), rows[i].count, weights.begin() + first[i]);
        first[i + 1] = first[i] + rows[i].count;
    }
    out.points = std::move(points).to_array();
    out.parents = {std::move(first).to_array(), std::move(corners).to_array(), std::move(weights).to_array()};
}

} // namespace

void describe_hanging(const OpenFaces& open, const Covers& covers, const core::PointReader& points, bool single,
                      ClosedGrid& out) {
    HangingRowMaker maker(open, covers, points);
    const std::vector<HangingRow> rows = maker.make();
    put_rows(rows, out);
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
            const std::uint64_t parts = cover.between[k].size();
            report.levels = std::max<std::uint64_t>(report.levels, static_cast<std::uint64_t>(std::bit_width(parts)));
        }
        const double tolerance = in_place * std::sqrt(longest) + (single ? roundings * largest : 0);
        if (!(distances[i] > tolerance)) continue;
        ++report.near_faces;
        report.largest_distance = std::max(report.largest_distance, distances[i]);
    }
    if (report.points > 0) report.levels = std::max<std::uint64_t>(report.levels, 1);
}

} // namespace isotet::linear
