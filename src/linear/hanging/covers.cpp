// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "linear/hanging/covers.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <span>
#include <tuple>
#include <utility>

#include "base/parallel.hpp"
#include "linear/hanging/face_place.hpp"
#include "linear/hanging/place_tree.hpp"
#include "linear/vector.hpp"

namespace isotet::linear {

namespace {

constexpr double largest_share = 0.999; // of a face's area: one that covers it with others
constexpr double most_cosine = -0.5;    // between the normals
constexpr double beside_face = 0.25;    // of the largest extent: a face that curved shapes put beside its place
constexpr double beside_edge = 0.25;    // of its length: a point that curved shapes put beside it
constexpr double near_face = 0.1;       // likewise: one that may lie on it
constexpr double on_face = 1e-3;        // likewise: one that lies on it
// The farthest ones may be beside another face that looks the same way: so the nearest are tried first.
constexpr std::array<double, 4> farthest_shares = {on_face, 1e-2, 5e-2, beside_face};
constexpr int max_rounds = 32;          // of edges that get points of others

/// A face's shape, turned outward.
struct ShapeOfFace {
    Point middle{}, normal{}; ///< the normal has twice the face's area
    Point lower{}, upper{};
    double extent = 0;

    double squared_area() const { return dot(normal, normal); } ///< four times the area's square
};

struct DirectedEdge {
    std::uint64_t low, high;
    bool forward; ///< from low to high
};

class CoverFinder {
public:
    CoverFinder(const OpenFaces& faces, const core::CellReader& cells, const core::PointReader& points)
        : faces_(faces), points_(points), shapes_(faces.size()), turned_(faces.size()), tree_(shape_all(cells)) {
        note_smallest(cells.points());
    }

    std::vector<Cover> find_candidates(const Progress& progress) const {
        std::vector<Cover> all(faces_.size());
        core::parallel_pieces(faces_.size(), 1 << 9, progress, [&](std::size_t begin, std::size_t end) {
            for (std::size_t face = begin; face < end; ++face) {
                all[face].face = face;
                if (!meets_smaller(face)) continue;
                for (const auto& [other, distance] : smaller_of(face)) {
                    all[face].by.push_back(other);
                    all[face].distances.push_back(distance);
                }
            }
        });
        std::erase_if(all, [](const Cover& cover) { return cover.by.size() < 2; });
        return all;
    }

    bool has_any_smaller() const {
        std::atomic<bool> found{false};
        core::parallel_ranges(faces_.size(), 1 << 9, [&](std::size_t begin, std::size_t end) {
            for (std::size_t face = begin; face < end && !found.load(std::memory_order_relaxed); ++face)
                if (std::ranges::any_of(smaller_of(face), [](const Smaller& one) { return one.distance <= near_face; }))
                    found.store(true, std::memory_order_relaxed);
        });
        return found;
    }

    /// Sets between and is_whole where those faces that are not farther have the outline, with the points on edges that
    /// are known. Others are dropped then.
    /// `used`   by face: those that cover another one already
    void look_for_cover(Cover& cover, double farthest, const std::vector<std::uint8_t>& used,
                        const SplitEdges& edges) const;

    /// Whether the faces lie on it and share a corner with it.
    bool looks_covered(const Cover& cover) const {
        const auto loop = faces_.loop(cover.face);
        return std::ranges::any_of(cover.by, [&](std::uint32_t other) {
            return lies_on(cover.face, other) && std::ranges::any_of(faces_.loop(other), [&](std::uint64_t point) {
                return std::ranges::find(loop, point) != loop.end();
            });
        });
    }

private:
    /// Too far for a point of the edge.
    bool is_beside_edge(std::uint64_t from, std::uint64_t to, std::uint64_t point) const {
        const double distance = place_on_edge(points_[from], points_[to], points_[point]).distance;
        return !(distance * distance <= beside_edge * beside_edge * core::squared_distance(points_[from], points_[to]));
    }

    /// Where `some` have the outline of a cover's face.
    bool find_outline(Cover& cover, std::span<const std::uint32_t> some, const SplitEdges& edges) const;

    std::vector<Point> shape_all(const core::CellReader& cells) {
        std::vector<Point> middles(faces_.size());
        core::parallel_each(faces_.size(), 1 << 10, [&](std::size_t i) {
            shapes_[i] = shape_of_face(faces_.loop(i));
            middles[i] = shapes_[i].middle;
            const std::uint64_t cell = faces_.place(i).cell;
            Point inside{};
            const std::uint64_t count = cells.corners(cell);
            for (std::uint64_t k = 0; k < count; ++k)
                for (std::size_t axis = 0; axis < 3; ++axis)
                    inside[axis] += points_[cells.corner(cells.first(cell) + k)][axis] / static_cast<double>(count);
            turned_[i] = dot(shapes_[i].normal, minus(shapes_[i].middle, inside)) < 0;
            if (turned_[i])
                for (double& x : shapes_[i].normal) x = -x;
        });
        return middles;
    }

    void note_smallest(std::size_t points) {
        smallest_.assign(points, std::numeric_limits<double>::infinity());
        for (std::size_t face = 0; face < faces_.size(); ++face)
            for (const std::uint64_t point : faces_.loop(face))
                smallest_[point] = std::min(smallest_[point], shapes_[face].squared_area());
    }

    /// What covers a face has its corners: a smaller one is at some of them.
    bool meets_smaller(std::size_t face) const {
        const double area = shapes_[face].squared_area();
        return std::ranges::any_of(faces_.loop(face), [&](std::uint64_t point) { return smallest_[point] < area; });
    }

    ShapeOfFace shape_of_face(std::span<const std::uint64_t> loop) const {
        ShapeOfFace out;
        const Point origin = points_[loop[0]];
        out.lower = out.upper = origin;
        for (std::size_t i = 0; i < loop.size(); ++i) { // Newell's normal
            const Point at = points_[loop[i]];
            const Point part = cross(minus(at, origin), minus(points_[loop[(i + 1) % loop.size()]], origin));
            for (std::size_t axis = 0; axis < 3; ++axis) {
                out.normal[axis] += part[axis];
                out.middle[axis] += at[axis] / static_cast<double>(loop.size());
                out.lower[axis] = std::min(out.lower[axis], at[axis]);
                out.upper[axis] = std::max(out.upper[axis], at[axis]);
            }
        }
        out.extent = std::sqrt(core::squared_distance(out.lower, out.upper));
        return out;
    }

    struct Smaller {
        std::uint32_t face;
        double distance;
    };

    /// Those that may cover a face, ascending.
    std::vector<Smaller> smaller_of(std::size_t face) const {
        std::vector<Smaller> out;
        const ShapeOfFace& shape = shapes_[face];
        const double more = beside_face * shape.extent;
        Point lower = shape.lower, upper = shape.upper;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            lower[axis] -= more;
            upper[axis] += more;
        }
        tree_.each_in(lower, upper, [&](std::uint32_t other) {
            if (faces_.place(other).cell == faces_.place(face).cell || !is_over(face, other)) return;
            if (const double far = distance(face, other); far <= beside_face) out.push_back({other, far});
        });
        std::ranges::sort(out, {}, &Smaller::face);
        return out;
    }

    /// A smaller face that faces the other way, with its middle over a face.
    bool is_over(std::size_t face, std::size_t other) const {
        const ShapeOfFace &shape = shapes_[face], &small = shapes_[other];
        const double area = shape.squared_area(), small_area = small.squared_area();
        if (!(area > 0) || !(small_area < largest_share * largest_share * area)) return false;
        if (!(dot(shape.normal, small.normal) < most_cosine * std::sqrt(area) * std::sqrt(small_area))) return false;
        const auto loop = faces_.loop(face);
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const Point at = points_[loop[i]];
            const Point along = minus(points_[loop[(i + 1) % loop.size()]], at);
            const double inside = dot(cross(along, minus(small.middle, at)), shape.normal);
            if (turned_[face] ? inside > 0 : inside < 0) return false;
        }
        const double height = std::abs(dot(minus(small.middle, shape.middle), shape.normal)) / std::sqrt(area);
        return height <= 2 * beside_face * shape.extent;
    }

    /// Of the middle of one face from another, in extents of that.
    double distance(std::size_t face, std::size_t other) const {
        return place_on_face(faces_.loop(face), shapes_[other].middle, points_).distance / shapes_[face].extent;
    }
    bool lies_on(std::size_t face, std::size_t other) const { return distance(face, other) <= on_face; }

    /// The edges of some faces, each turned outward, but for those that two of them have.
    std::vector<DirectedEdge> outline_of(std::span<const std::uint32_t> some, const SplitEdges& edges) const;

    const OpenFaces& faces_;
    const core::PointReader& points_;
    std::vector<ShapeOfFace> shapes_;
    std::vector<std::uint8_t> turned_; ///< loops that are clockwise seen from outside of their cells
    PlaceTree tree_;                   ///< of their middles
    std::vector<double> smallest_;     ///< by point: the squared area of the smallest face that has it
};

std::vector<DirectedEdge> CoverFinder::outline_of(std::span<const std::uint32_t> some, const SplitEdges& edges) const {
    std::vector<DirectedEdge> all;
    std::vector<std::uint64_t> loop;
    for (const std::uint32_t face : some) {
        loop.clear();
        edges.expand(faces_.loop(face), loop);
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const std::uint64_t a = loop[i], b = loop[(i + 1) % loop.size()];
            all.push_back({std::min(a, b), std::max(a, b), (a < b) != (turned_[face] != 0)});
        }
    }
    std::ranges::sort(all, [](const DirectedEdge& a, const DirectedEdge& b) {
        return std::tie(a.low, a.high, a.forward) < std::tie(b.low, b.high, b.forward);
    });
    std::vector<DirectedEdge> out;
    for (std::size_t begin = 0, end = 0; begin < all.size(); begin = end) {
        end = begin + 1;
        while (end < all.size() && all[end].low == all[begin].low && all[end].high == all[begin].high) ++end;
        if (end == begin + 2 && all[begin].forward != all[begin + 1].forward) continue;
        for (std::size_t i = begin; i < end; ++i) out.push_back(all[i]);
    }
    return out;
}

void CoverFinder::look_for_cover(Cover& cover, double farthest, const std::vector<std::uint8_t>& used,
                                 const SplitEdges& edges) const {
    std::vector<std::uint32_t> some;
    for (std::size_t i = 0; i < cover.by.size(); ++i)
        if (cover.distances[i] <= farthest && !used[cover.by[i]]) some.push_back(cover.by[i]);
    if (find_outline(cover, some, edges)) cover.by = std::move(some);
}

bool CoverFinder::find_outline(Cover& cover, std::span<const std::uint32_t> some, const SplitEdges& edges) const {
    // The faces look the other way: seen from the cell of the larger one, their edges run as its own do.
    std::vector<std::pair<std::uint64_t, std::uint64_t>> next;
    for (const DirectedEdge& edge : outline_of(some, edges)) {
        const bool forward = edge.forward == (turned_[cover.face] != 0);
        next.emplace_back(forward ? edge.low : edge.high, forward ? edge.high : edge.low);
    }
    std::ranges::sort(next);
    const auto same_start = [](const auto& a, const auto& b) { return a.first == b.first; };
    if (next.empty() || std::ranges::adjacent_find(next, same_start) != next.end()) return false;
    const auto loop = faces_.loop(cover.face);
    std::vector<std::vector<std::uint64_t>> between(loop.size());
    std::uint64_t at = loop[0];
    std::size_t steps = 0;
    for (std::size_t i = 0; i < loop.size(); ++i) {
        const std::uint64_t end = loop[(i + 1) % loop.size()];
        for (;;) {
            const auto step = std::ranges::lower_bound(next, at, {}, [](const auto& edge) { return edge.first; });
            if (step == next.end() || step->first != at || steps == next.size()) return false;
            at = step->second;
            ++steps;
            if (at == end) break;
            if (is_beside_edge(loop[i], end, at)) return false;
            between[i].push_back(at);
        }
    }
    if (steps != next.size()) return false;
    cover.between = std::move(between);
    return cover.is_whole = true;
}

/// Whether the covering faces have points that the face does not have.
bool has_more_points(const Cover& cover, const OpenFaces& faces) {
    const auto loop = faces.loop(cover.face);
    return std::ranges::any_of(cover.by, [&](std::uint32_t other) {
        return std::ranges::any_of(faces.loop(other), [&](std::uint64_t point) {
            return std::ranges::find(loop, point) == loop.end();
        });
    });
}

void add_edges(const Cover& cover, std::span<const std::uint64_t> loop, std::vector<PointOnEdge>& out) {
    for (std::size_t i = 0; i < loop.size(); ++i) {
        const auto [low, high] = std::minmax(loop[i], loop[(i + 1) % loop.size()]);
        for (const std::uint64_t point : cover.between[i]) out.push_back({low, high, point});
    }
}

/// Where two faces at an edge are covered by edges of different length, each has the points of the other.
std::vector<PointOnEdge> points_of_others(const std::vector<Cover>& whole, const OpenFaces& faces,
                                          const SplitEdges& edges) {
    std::vector<PointOnEdge> out;
    std::vector<std::uint64_t> all;
    for (const Cover& cover : whole) {
        const auto loop = faces.loop(cover.face);
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const std::uint64_t end = loop[(i + 1) % loop.size()];
            all.clear();
            edges.append_between(loop[i], end, all);
            if (all.size() == cover.between[i].size()) continue;
            std::vector<std::uint64_t> own = cover.between[i];
            own.push_back(end);
            std::uint64_t before = loop[i];
            auto next = all.begin();
            for (const std::uint64_t point : own) {
                for (; next != all.end() && *next != point; ++next) {
                    const auto [low, high] = std::minmax(before, point);
                    out.push_back({low, high, *next});
                }
                if (next != all.end()) ++next;
                before = point;
            }
        }
    }
    return out;
}

/// Moves faces that are covered from those that wait to `out`. False where there is none.
bool take_whole(const CoverFinder& finder, const OpenFaces& faces, double farthest, std::vector<std::uint8_t>& used,
                std::vector<Cover>& waiting, Covers& out) {
    core::parallel_each(waiting.size(), 1 << 8,
                        [&](std::size_t i) { finder.look_for_cover(waiting[i], farthest, used, out.edges); });
    std::vector<PointOnEdge> found;
    std::vector<Cover> rest;
    for (Cover& cover : waiting) {
        if (used[cover.face]) continue; // a face that covers another is not covered
        if (!cover.is_whole) {
            rest.push_back(std::move(cover));
        } else if (has_more_points(cover, faces) &&
                   std::ranges::none_of(cover.by, [&](std::uint32_t other) { return used[other] != 0; })) {
            for (const std::uint32_t other : cover.by) used[other] = 1;
            used[cover.face] = 1;
            add_edges(cover, faces.loop(cover.face), found);
            out.whole.push_back(std::move(cover));
        }
    }
    const bool some = rest.size() < waiting.size();
    waiting = std::move(rest);
    out.edges.add(std::move(found));
    return some;
}

} // namespace

Result<Covers> find_covers(const OpenFaces& faces, const core::CellReader& cells, const core::PointReader& points,
                           const Progress& progress) {
    const CoverFinder finder(faces, cells, points);
    std::vector<Cover> waiting = finder.find_candidates(progress);
    Covers out{{}, SplitEdges(points), 0};
    std::vector<std::uint8_t> used(faces.size());
    for (const double farthest : farthest_shares)
        while (!waiting.empty() && !progress.cancelled() && take_whole(finder, faces, farthest, used, waiting, out)) {}
    if (progress.cancelled()) return Error{ErrorCode::cancelled, "looking for hanging points was cancelled"};
    for (int round = 0; round < max_rounds; ++round) {
        const std::size_t before = out.edges.all().size();
        out.edges.add(points_of_others(out.whole, faces, out.edges));
        if (out.edges.all().size() == before) break;
    }
    out.open = static_cast<std::uint64_t>(
        std::ranges::count_if(waiting, [&](const Cover& cover) { return finder.looks_covered(cover); }));
    std::ranges::sort(out.whole, {}, &Cover::face);
    return out;
}

bool has_smaller_faces(const OpenFaces& faces, const core::CellReader& cells, const core::PointReader& points) {
    return CoverFinder(faces, cells, points).has_any_smaller();
}

} // namespace isotet::linear
