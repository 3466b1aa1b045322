// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "linear/hanging/covers.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <span>
#include <tuple>
#include <utility>

#include "base/parallel.hpp"
#include "linear/hanging/face_place.hpp"
#include "linear/hanging/face_shapes.hpp"
#include "linear/vector.hpp"

namespace isotet::linear {

namespace {

constexpr double beside_edge = 0.25;    // of its length: a point that curved shapes put beside it
constexpr double inside_hole = 5e-2;    // of a face's extent: a point inside it that may be the corner of a hole
constexpr double inside_beside =
    2.5; // of the distance of points from edges: of one inside a face of a curved shape, besides
constexpr double on_face = 1e-3;        // of a face's extent: one that lies on it
// The farthest ones may be beside another face that looks the same way: so the nearest are tried first.
constexpr std::array<double, 4> farthest_shares = {on_face, 1e-2, 5e-2, beside_face};
constexpr int max_rounds = 32;          // of edges that get points of others

/// Which faces have a point.
class FacesAtPoints {
public:
    FacesAtPoints(const OpenFaces& faces, std::uint64_t points) : first_(points + 1) {
        for (std::size_t face = 0; face < faces.size(); ++face)
            for (const std::uint64_t point : faces.loop(face)) ++first_[point];
        std::size_t sum = 0;
        for (std::size_t& first : first_) first = sum += first;
        faces_.resize(sum);
        for (std::size_t face = faces.size(); face-- > 0;)
            for (const std::uint64_t point : faces.loop(face))
                faces_[--first_[point]] = static_cast<std::uint32_t>(face);
    }
    std::span<const std::uint32_t> operator[](std::uint64_t point) const {
        return {faces_.data() + first_[point], first_[point + 1] - first_[point]};
    }

private:
    std::vector<std::size_t> first_;
    std::vector<std::uint32_t> faces_;
};

/// The faces that meet a smaller one in a corner: what covers a face has its corners.
std::vector<std::uint32_t> larger_ones(const OpenFaces& faces, std::uint64_t points, const core::PointReader& places) {
    std::vector<double> areas(faces.size()), smallest(points, std::numeric_limits<double>::infinity());
    core::parallel_each(faces.size(), 1 << 10, [&](std::size_t face) {
        const Point normal = normal_of(faces.loop(face), places);
        areas[face] = dot(normal, normal);
    });
    for (std::size_t face = 0; face < faces.size(); ++face)
        for (const std::uint64_t point : faces.loop(face)) smallest[point] = std::min(smallest[point], areas[face]);
    std::vector<std::uint32_t> out;
    for (std::size_t face = 0; face < faces.size(); ++face) {
        const double share = largest_share * largest_share * areas[face];
        if (std::ranges::any_of(faces.loop(face), [&](std::uint64_t point) { return smallest[point] < share; }))
            out.push_back(static_cast<std::uint32_t>(face));
    }
    return out;
}

/// Too far for a point of the edge.
bool is_beside_edge(const core::PointReader& points, std::uint64_t from, std::uint64_t to, std::uint64_t point) {
    const double distance = place_on_edge(points[from], points[to], points[point]).distance;
    return !(distance * distance <= beside_edge * beside_edge * core::squared_distance(points[from], points[to]));
}

/// Smaller faces over larger ones, from the corners of these on: those that cover a face hang together.
class CandidateFinder {
public:
    /// All borrowed.
    CandidateFinder(const OpenFaces& faces, const FaceShapes& shapes, const core::PointReader& points,
                    const FacesAtPoints& at_points)
        : faces_(faces), shapes_(shapes), points_(points), at_points_(at_points) {}

    void find(Cover& cover) {
        found_.clear();
        const auto corners = faces_.loop(cover.face);
        for (const std::uint64_t corner : corners) look_around(cover.face, corner);
        if (found_.size() != 4 || !find_quarters(cover))
            for (std::size_t next = 0; next < found_.size(); ++next)
                for (const std::uint64_t point : faces_.loop(found_[next].face))
                    if (std::ranges::find(corners, point) == corners.end()) look_around(cover.face, point);
        std::ranges::sort(found_, {}, &Cover::Part::face);
        cover.by.assign(found_.begin(), found_.end());
    }

private:
    void look_around(std::size_t face, std::uint64_t point) {
        for (const std::uint32_t other : at_points_[point]) {
            if (!shapes_.is_over(face, other)) continue;
            if (std::ranges::find(found_, other, &Cover::Part::face) != found_.end()) continue;
            if (const double far = shapes_.distance(face, other); far <= beside_face) found_.push_back({other, far});
        }
    }

    /// The most frequent cover at once: a quadrilateral on four around a point, one at each corner.
    bool find_quarters(Cover& cover) const {
        const auto loop = faces_.loop(cover.face);
        if (loop.size() != 4) return false;
        std::array<Quarter, 4> around{};
        for (std::size_t i = 0; i < 4; ++i)
            if (!(found_[i].distance <= on_face) || !find_quarter(cover.face, loop[i], found_[i].face, around[i]))
                return false;
        for (std::size_t i = 0; i < 4; ++i) {
            const Quarter &one = around[i], &next = around[(i + 1) % 4];
            const auto is_after = [&](const Quarter& other) { return other.after == one.after; };
            if (one.after != next.before || one.middle != next.middle || one.after == one.middle) return false;
            if (std::ranges::count_if(around, is_after) != 1) return false;
            for (const std::uint64_t corner : loop)
                if (corner == one.after || corner == one.middle) return false;
            if (is_beside_edge(points_, loop[i], loop[(i + 1) % 4], one.after)) return false;
        }
        for (std::uint32_t i = 0; i < 4; ++i) cover.between.push_back({i, around[i].after});
        return cover.is_whole = true;
    }

    /// A quadrilateral from a corner on, in the direction of the larger one's loop.
    struct Quarter {
        std::uint64_t before, after, middle;
    };
    bool find_quarter(std::size_t face, std::uint64_t corner, std::uint32_t other, Quarter& out) const {
        const auto loop = faces_.loop(other);
        const auto at = static_cast<std::size_t>(std::ranges::find(loop, corner) - loop.begin());
        if (loop.size() != 4 || at == 4) return false;
        out = {loop[(at + 3) % 4], loop[(at + 1) % 4], loop[(at + 2) % 4]};
        if (shapes_.is_turned(face) == shapes_.is_turned(other)) std::swap(out.before, out.after);
        return true;
    }

    const OpenFaces& faces_;
    const FaceShapes& shapes_;
    const core::PointReader& points_;
    const FacesAtPoints& at_points_;
    std::vector<Cover::Part> found_;
};

std::vector<Cover> find_candidates(const std::vector<std::uint32_t>& larger, const OpenFaces& faces,
                                   const FaceShapes& shapes, const core::PointReader& places, std::uint64_t points,
                                   const Progress& progress) {
    const FacesAtPoints at_points(faces, points);
    std::vector<Cover> all(larger.size());
    core::parallel_pieces(larger.size(), 1 << 8, progress, [&](std::size_t begin, std::size_t end) {
        CandidateFinder finder(faces, shapes, places, at_points);
        for (std::size_t i = begin; i < end; ++i) {
            all[i].face = larger[i];
            finder.find(all[i]);
        }
    });
    std::erase_if(all, [](const Cover& cover) { return cover.by.size() < 2; });
    return all;
}

struct DirectedEdge {
    std::uint64_t low, high;
    bool forward; ///< from low to high
};

/// Finds out whether some faces have the outline of a larger one. Keeps memory for the next.
class OutlineFinder {
public:
    OutlineFinder(const OpenFaces& faces, const FaceShapes& shapes, const core::PointReader& points,
                  const SplitEdges& edges)
        : faces_(faces), shapes_(shapes), points_(points), edges_(edges) {}

    /// Sets between and is_whole where those faces that are not farther have the outline, with the points on edges that
    /// are known. Others are dropped then.
    /// `used`   by face: those that cover another one already
    void look_for_cover(Cover& cover, double farthest, const std::vector<std::uint8_t>& used) {
        some_.clear();
        for (const Cover::Part& part : cover.by)
            if (part.distance <= farthest && !used[part.face]) some_.push_back(part);
        if (!find_outline(cover)) return;
        if (!are_near(cover)) return cover.between.clear();
        cover.is_whole = true;
        cover.by.assign(some_.begin(), some_.end());
    }

private:
    bool find_outline(Cover& cover) {
        if (some_.empty()) return false;
        find_steps(shapes_.is_turned(cover.face));
        const auto same_start = [](const Step& a, const Step& b) { return a.from == b.from; };
        if (steps_.empty() || std::ranges::adjacent_find(steps_, same_start) != steps_.end()) return false;
        const auto loop = faces_.loop(cover.face);
        between_.clear();
        std::uint64_t at = loop[0];
        std::size_t taken = 0;
        for (std::size_t i = 0; i < loop.size(); ++i) {
            const std::uint64_t end = loop[(i + 1) % loop.size()];
            for (;;) {
                const auto step = std::ranges::lower_bound(steps_, at, {}, &Step::from);
                if (step == steps_.end() || step->from != at || taken == steps_.size()) return false;
                at = step->to;
                ++taken;
                if (at == end) break;
                if (is_beside_edge(points_, loop[i], end, at)) return false;
                between_.push_back({static_cast<std::uint32_t>(i), at});
            }
        }
        if (taken != steps_.size()) return false;
        cover.between.assign(between_.begin(), between_.end());
        return true;
    }

    /// Whether the points inside are about as near to the face as those on its edges are to these. Else the faces may go around
    /// a hole, as those of cells around a missing pyramid do.
    bool are_near(const Cover& cover) const {
        const auto loop = faces_.loop(cover.face);
        double beside = 0; // of points on edges
        for (const Cover::OnEdge& on : between_) {
            const Point from = points_[loop[on.edge]], to = points_[loop[(on.edge + 1) % loop.size()]];
            beside = std::max(beside, place_on_edge(from, to, points_[on.point]).distance);
        }
        const double most = inside_hole * shapes_.extent(cover.face) + inside_beside * beside;
        return std::ranges::all_of(some_, [&](const Cover::Part& part) {
            return std::ranges::all_of(faces_.loop(part.face), [&](std::uint64_t point) {
                return std::ranges::find(loop, point) != loop.end() ||
                       std::ranges::find(between_, point, &Cover::OnEdge::point) != between_.end() ||
                       place_on_face(loop, points_[point], points_).distance <= most;
            });
        });
    }

    /// The edges of some faces, but for those that two of them have in opposite directions. They look the other way:
    /// seen from the cell of the larger one, their edges run as its own do.
    void find_steps(bool is_turned) {
        all_.clear();
        for (const Cover::Part& part : some_) {
            loop_.clear();
            edges_.expand(faces_.loop(part.face), loop_);
            const bool reversed = shapes_.is_turned(part.face);
            std::uint64_t a = loop_.back();
            for (const std::uint64_t b : loop_) {
                all_.push_back({std::min(a, b), std::max(a, b), (a < b) != reversed});
                a = b;
            }
        }
        std::ranges::sort(all_, [](const DirectedEdge& a, const DirectedEdge& b) {
            return std::tie(a.low, a.high, a.forward) < std::tie(b.low, b.high, b.forward);
        });
        steps_.clear();
        for (std::size_t begin = 0, end = 0; begin < all_.size(); begin = end) {
            end = begin + 1;
            while (end < all_.size() && all_[end].low == all_[begin].low && all_[end].high == all_[begin].high) ++end;
            if (end == begin + 2 && all_[begin].forward != all_[begin + 1].forward) continue;
            for (std::size_t i = begin; i < end; ++i)
                if (all_[i].forward == is_turned) steps_.push_back({all_[i].low, all_[i].high});
                else steps_.push_back({all_[i].high, all_[i].low});
        }
        std::ranges::sort(steps_, {}, &Step::from);
    }

    struct Step {
        std::uint64_t from, to;
    };

    const OpenFaces& faces_;
    const FaceShapes& shapes_;
    const core::PointReader& points_;
    const SplitEdges& edges_;
    std::vector<Cover::Part> some_;
    std::vector<DirectedEdge> all_;
    std::vector<Step> steps_;
    std::vector<std::uint64_t> loop_;
    std::vector<Cover::OnEdge> between_;
};

/// Whether some of the faces lie on it and share a corner with it.
bool looks_covered(const Cover& cover, const OpenFaces& faces) {
    const auto loop = faces.loop(cover.face);
    return std::ranges::any_of(cover.by, [&](const Cover::Part& part) {
        return part.distance <= on_face && std::ranges::any_of(faces.loop(part.face), [&](std::uint64_t point) {
            return std::ranges::find(loop, point) != loop.end();
        });
    });
}

/// Whether the covering faces have points that the face does not have.
bool has_more_points(const Cover& cover, const OpenFaces& faces) {
    const auto loop = faces.loop(cover.face);
    return std::ranges::any_of(cover.by, [&](const Cover::Part& part) {
        return std::ranges::any_of(faces.loop(part.face), [&](std::uint64_t point) {
            return std::ranges::find(loop, point) == loop.end();
        });
    });
}

void add_edges(const Cover& cover, std::span<const std::uint64_t> loop, std::vector<PointOnEdge>& out) {
    for (const Cover::OnEdge& on : cover.between) {
        const auto [low, high] = std::minmax(loop[on.edge], loop[(on.edge + 1) % loop.size()]);
        out.push_back({low, high, on.point});
    }
}

/// Where two faces at an edge are covered by edges of different length, each has the points of the other.
std::vector<PointOnEdge> points_of_others(const std::vector<Cover>& whole, const OpenFaces& faces,
                                          const SplitEdges& edges) {
    std::vector<PointOnEdge> out;
    std::vector<std::uint64_t> all, own;
    for (const Cover& cover : whole) {
        const auto loop = faces.loop(cover.face);
        auto on = cover.between.begin();
        for (std::size_t i = 0; i < loop.size(); ++i) {
            own.clear();
            for (; on != cover.between.end() && on->edge == i; ++on) own.push_back(on->point);
            const std::uint64_t end = loop[(i + 1) % loop.size()];
            all.clear();
            edges.append_between(loop[i], end, all);
            if (all.size() == own.size()) continue;
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

/// What is found of covers, and what is not yet.
struct Search {
    const OpenFaces& faces;
    const FaceShapes& shapes;
    const core::PointReader& points;
    std::vector<Cover> waiting;
    std::vector<std::uint8_t> used; ///< by face: covers another one, or is covered
};

/// Moves faces that are covered from those that wait to `out`. False where there is none.
bool take_whole(Search& search, double farthest, Covers& out) {
    const OpenFaces& faces = search.faces;
    core::parallel_ranges(search.waiting.size(), 1 << 8, [&](std::size_t begin, std::size_t end) {
        OutlineFinder finder(faces, search.shapes, search.points, out.edges);
        for (std::size_t i = begin; i < end; ++i)
            if (!search.waiting[i].is_whole) finder.look_for_cover(search.waiting[i], farthest, search.used);
    });
    const auto is_used = [&](const Cover::Part& part) { return search.used[part.face] != 0; };
    std::vector<PointOnEdge> found;
    std::vector<Cover> rest;
    for (Cover& cover : search.waiting) {
        if (search.used[cover.face]) continue; // a face that covers another is not covered
        if (!cover.is_whole) {
            rest.push_back(std::move(cover));
        } else if (has_more_points(cover, faces) && std::ranges::none_of(cover.by, is_used)) {
            for (const Cover::Part& part : cover.by) search.used[part.face] = 1;
            search.used[cover.face] = 1;
            add_edges(cover, faces.loop(cover.face), found);
            out.whole.push_back(std::move(cover));
        }
    }
    const bool some = rest.size() < search.waiting.size();
    search.waiting = std::move(rest);
    out.edges.add(found);
    return some;
}

} // namespace

Result<Covers> find_covers(const OpenFaces& faces, const core::CellReader& cells, const core::PointReader& points,
                           const Progress& progress) {
    Covers out{{}, SplitEdges(points)};
    const std::vector<std::uint32_t> larger = larger_ones(faces, cells.points(), points);
    if (larger.empty()) return out;
    const FaceShapes shapes(faces, cells, points);
    Search search{faces, shapes, points, find_candidates(larger, faces, shapes, points, cells.points(), progress),
                  std::vector<std::uint8_t>(faces.size())};
    for (const double farthest : farthest_shares)
        while (!search.waiting.empty() && !progress.cancelled() && take_whole(search, farthest, out)) {}
    if (progress.cancelled()) return Error{ErrorCode::cancelled, "looking for hanging points was cancelled"};
    for (int round = 0; round < max_rounds; ++round) {
        const std::size_t before = out.edges.size();
        out.edges.add(points_of_others(out.whole, faces, out.edges));
        if (out.edges.size() == before) break;
    }
    for (Cover& cover : search.waiting)
        if (looks_covered(cover, faces)) out.open.push_back(std::move(cover));
    std::ranges::sort(out.whole, {}, &Cover::face);
    return out;
}

} // namespace isotet::linear
