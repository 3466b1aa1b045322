// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/surface.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <new>
#include <span>
#include <string_view>
#include <tuple>
#include <utility>

#include <fmt/core.h>
#include <meshoptimizer.h>
#include <tbb/parallel_sort.h>

#include "base/system/apart.hpp"
#include "base/carry_out.hpp"
#include "base/errors.hpp"
#include "base/system/memory.hpp"
#include "base/until_cancelled.hpp"
#include "check/mesh.hpp"
#include "grid/surface_rows.hpp"
#include "check/triangle_groups.hpp"

namespace isotet {
namespace checking {
namespace {

constexpr std::array<std::string_view, 3> kept_fields{"isovalue", "part", "boundary"};
constexpr std::uint64_t bytes_a_triangle = 150;

bool is_kept(const Field& field) { return std::ranges::find(kept_fields, field.name) != kept_fields.end(); }

/// Triangles of one group with vertices numbered from 0: what meshoptimizer takes.
struct Piece {
    std::vector<std::uint64_t> vertices; ///< ascending: those of the surface
    std::vector<unsigned> indices;
    std::vector<float> positions; ///< relative to the first vertex
};

constexpr std::size_t stride_of_positions = 3 * sizeof(float);

constexpr std::size_t looked_at_once = 1 << 14; ///< triangles or vertices between two looks for a cancel

/// Makes one piece after another.
class PieceMaker {
public:
    PieceMaker(const Mesh& mesh, const Progress& progress)
        : mesh_(mesh), progress_(progress), numbers_(mesh.vertex_count(), none) {}

    /// Of no use after a cancel.
    Piece operator()(std::span<const std::uint64_t> triangles) {
        Piece piece;
        for (std::size_t i = 0; i < triangles.size() && !(i % looked_at_once == 0 && progress_.cancelled()); ++i)
            for (const std::uint64_t vertex : mesh_.corners(triangles[i]))
                if (std::exchange(numbers_[vertex], 0) == none) piece.vertices.push_back(vertex);
        core::sort_until_cancelled(progress_, piece.vertices);
        for (std::size_t i = 0; i < piece.vertices.size(); ++i) numbers_[piece.vertices[i]] = static_cast<unsigned>(i);
        piece.indices.resize(3 * triangles.size());
        core::each_until_cancelled(triangles.size(), looked_at_once, progress_, [&](std::size_t i) {
            const Corners corners = mesh_.corners(triangles[i]);
            for (std::size_t k = 0; k < 3; ++k) piece.indices[3 * i + k] = numbers_[corners[k]];
        });
        piece.positions.resize(3 * piece.vertices.size());
        core::each_until_cancelled(piece.vertices.size(), looked_at_once, progress_, [&](std::size_t i) {
            const core::Point place = mesh_.position(piece.vertices[i]), origin = mesh_.position(piece.vertices[0]);
            for (std::size_t axis = 0; axis < 3; ++axis)
                piece.positions[3 * i + axis] = static_cast<float>(place[axis] - origin[axis]);
        });
        for (const std::uint64_t vertex : piece.vertices) numbers_[vertex] = none;
        return piece;
    }

private:
    static constexpr unsigned none = std::numeric_limits<unsigned>::max();

    const Mesh& mesh_;
    const Progress& progress_;
    std::vector<unsigned> numbers_; ///< of the vertices of the piece that is being made
};

/// What is left of a piece.
struct Simplified {
    std::vector<unsigned> indices;
    double error = 0; ///< in units of the grid

    std::size_t triangles() const { return indices.size() / 3; }
};

/// What meshoptimizer made of a piece.
struct Outcome {
    std::size_t indices = 0;
    float error = 0;
};

/// meshopt_simplify(), which cannot be asked to stop: where it lasts, in a process of its own.
///
/// Errors   by exception: std::bad_alloc
class Simplifier {
public:
    Simplifier(const Piece& piece, std::size_t wanted, float error) : piece_(piece), wanted_(wanted), error_(error) {}

    /// Puts what is left into `indices`. Nothing is left after a cancel.
    float run(std::vector<unsigned>& indices, const Progress& progress) const {
        constexpr std::size_t soon_done = 3 << 15;
        indices.clear();
        const std::size_t all = piece_.indices.size();
        const core::SharedMemory memory(all < soon_done ? 1 : sizeof(Outcome) + all * sizeof(unsigned));
        core::Apart ended = core::Apart::refused;
        if (all >= soon_done && memory.data()) {
            auto* const outcome = new (memory.data()) Outcome;
            auto* const left = reinterpret_cast<unsigned*>(outcome + 1);
            ended = core::run_apart(progress, [&] {
                meshopt_setAllocator(core::take_pages, [](void*) {});
                *outcome = simplify(left);
            });
            if (ended == core::Apart::done) {
                indices.assign(left, left + outcome->indices);
                return outcome->error;
            }
        }
        if (ended == core::Apart::cancelled) return 0;
        indices.resize(all);
        const Outcome outcome = simplify(indices.data());
        indices.resize(outcome.indices);
        return outcome.error;
    }

private:
    Outcome simplify(unsigned* left) const {
        Outcome out;
        out.indices = meshopt_simplify(left, piece_.indices.data(), piece_.indices.size(), piece_.positions.data(),
                                       piece_.vertices.size(), stride_of_positions, 3 * wanted_, error_,
                                       meshopt_SimplifyLockBorder, &out.error);
        return out;
    }

    const Piece& piece_;
    std::size_t wanted_;
    float error_;
};

/// Leaves triangles out until `wanted` are left, or the next one would move the piece farther than `limit`. Nothing is
/// left after a cancel.
Simplified simplify(const Piece& piece, std::size_t wanted, double limit, const Progress& progress) {
    constexpr std::size_t least = 4; // of a piece: closed ones of fewer enclose nothing
    if (piece.indices.size() <= 3 * std::max(wanted, least)) return {piece.indices, 0};
    const auto scale =
        static_cast<double>(meshopt_simplifyScale(piece.positions.data(), piece.vertices.size(), stride_of_positions));
    const Simplifier simplifier(piece, std::max(wanted, least),
                                static_cast<float>(scale > 0 ? std::min(limit / scale, 1.0) : 0));
    Simplified out;
    out.error = static_cast<double>(simplifier.run(out.indices, progress)) * scale;
    return out;
}

/// How far one of several pieces may go.
struct Goal {
    std::size_t wanted = 0;
    double limit = 0;
};

/// Pieces are reduced to one error: each to its share of the triangles would move the one whose vertices are nearly all at
/// borders far, beside one that is flat.
class Goals {
public:
    Goals(std::span<const Piece> pieces, const ReduceOptions& options, const Progress& progress)
        : pieces_(pieces), progress_(progress) {
        for (const Piece& piece : pieces) {
            const std::size_t triangles = piece.indices.size() / 3;
            goals_.push_back({wanted_of(triangles, options), options.error});
            triangles_ += triangles;
        }
        wanted_ = wanted_of(triangles_, options);
        if (pieces.size() > 1) share_error();
    }

    const Goal& operator[](std::size_t piece) const { return goals_[piece]; }

private:
    static std::size_t wanted_of(std::size_t triangles, const ReduceOptions& options) {
        return static_cast<std::size_t>(std::ceil(static_cast<double>(triangles) * (1 - options.share)));
    }

    /// The triangles of each piece that are left at an error.
    struct Counts {
        double limit = 0;
        std::vector<std::size_t> left;
        std::size_t sum = 0;
    };
    Counts counts_at(double limit) const {
        Counts counts{limit, {}, 0};
        for (const Piece& piece : pieces_) {
            if (progress_.cancelled()) break;
            counts.left.push_back(simplify(piece, 0, limit, progress_).triangles());
            counts.sum += counts.left.back();
        }
        counts.left.resize(pieces_.size());
        return counts;
    }

    /// Between the errors of all pieces at their shares lies one at which all together have as many triangles as are wanted.
    void share_error() {
        constexpr int halvings = 5;
        double lowest = std::numeric_limits<double>::infinity(), highest = 0;
        for (std::size_t i = 0; i < pieces_.size() && !progress_.cancelled(); ++i) {
            const double error = simplify(pieces_[i], goals_[i].wanted, goals_[i].limit, progress_).error;
            lowest = std::min(lowest, error);
            highest = std::max(highest, error);
        }
        if (!(highest > 1.1 * lowest) || progress_.cancelled()) return;
        Counts above = counts_at(highest), below = counts_at(lowest);
        for (int i = 0; i < halvings && below.sum > wanted_ && !progress_.cancelled(); ++i) {
            Counts middle = counts_at(std::sqrt(std::max(below.limit, 1e-6 * above.limit) * above.limit));
            (middle.sum >= wanted_ ? below : above) = std::move(middle);
        }
        if (below.sum < wanted_) { // what goes without any error is more than may go
            above = std::exchange(below, {});
            for (const Piece& piece : pieces_) below.left.push_back(piece.indices.size() / 3);
            below.sum = triangles_;
        }
        const std::size_t between = below.sum - std::min(above.sum, below.sum);
        for (std::size_t i = 0; i < pieces_.size(); ++i) {
            // Of what goes between both errors as large a part of each as makes the sum.
            const std::size_t goes = below.left[i] - std::min(above.left[i], below.left[i]);
            const double part = between == 0 ? 0
                                             : static_cast<double>(below.sum - std::min(wanted_, below.sum)) /
                                                   static_cast<double>(between);
            goals_[i] = {below.left[i] -
                             static_cast<std::size_t>(std::floor(static_cast<double>(goes) * std::min(part, 1.0))),
                         above.limit};
        }
    }

    std::span<const Piece> pieces_;
    const Progress& progress_;
    std::vector<Goal> goals_;
    std::size_t triangles_ = 0, wanted_ = 0; ///< of all
};

/// What of the surface is left: triangles by numbers of its vertices, and for each a triangle of the surface that is of
/// the same group.
struct Left {
    std::vector<std::uint64_t> corners, like;
};

/// Takes away pairs of triangles on the same corners, back to back: where both sides of a border lost the vertices between
/// the same three of its own.
void cancel_double_sheets(Left& left, const Progress& progress) {
    struct Sheet {
        Corners corners; ///< ascending
        bool mirrored;
        std::uint64_t triangle;

        bool operator<(const Sheet& other) const {
            return std::tie(corners, mirrored, triangle) < std::tie(other.corners, other.mirrored, other.triangle);
        }
    };
    std::vector<Sheet> sheets(left.like.size());
    for (std::uint64_t i = 0; i < sheets.size(); ++i) {
        const Corners c = lowest_first({left.corners[3 * i], left.corners[3 * i + 1], left.corners[3 * i + 2]});
        const bool mirrored = c[1] > c[2];
        sheets[i] = {{c[0], std::min(c[1], c[2]), std::max(c[1], c[2])}, mirrored, i};
    }
    core::sort_until_cancelled(progress, std::less<>(),
                               [&](const auto& before) { tbb::parallel_sort(sheets.begin(), sheets.end(), before); });
    if (progress.cancelled()) return;
    std::vector<std::uint8_t> gone(sheets.size());
    for (std::size_t begin = 0, end = 0; begin < sheets.size(); begin = end) {
        while (end < sheets.size() && sheets[end].corners == sheets[begin].corners) ++end;
        // Upright ones stand first: the outermost pair is one of each until one kind is used up.
        for (std::size_t a = begin, b = end; a < b && !sheets[a].mirrored && sheets[b - 1].mirrored; ++a, --b)
            gone[sheets[a].triangle] = gone[sheets[b - 1].triangle] = 1;
    }
    Left kept;
    for (std::size_t i = 0; i < gone.size(); ++i) {
        if (gone[i]) continue;
        kept.corners.insert(kept.corners.end(), &left.corners[3 * i], &left.corners[3 * i] + 3);
        kept.like.push_back(left.like[i]);
    }
    left = std::move(kept);
}

/// The vertices that are left, with what belongs to them, and the new triangles.
Surface surface_of(const Surface& surface, const Left& left, const Progress& progress) {
    std::vector<std::uint64_t> vertices = left.corners;
    core::sort_until_cancelled(progress, vertices);
    vertices.erase(std::ranges::unique(vertices).begin(), vertices.end());
    Surface out;
    out.positions = core::rows_of(surface.positions, vertices);
    std::vector<std::uint32_t> triangles(left.corners.size());
    core::each_until_cancelled(triangles.size(), looked_at_once, progress, [&](std::size_t i) {
        const auto place = std::ranges::lower_bound(vertices, left.corners[i]);
        triangles[i] = static_cast<std::uint32_t>(place - vertices.begin());
    });
    if (progress.cancelled()) return out;
    out.triangles = Array::own(std::move(triangles), 3);
    if (surface.normals_kind == Normals::gradient) {
        out.normals_kind = Normals::gradient;
        out.normals = core::rows_of(surface.normals, vertices);
    }
    for (const Field& field : surface.point_fields)
        out.point_fields.push_back({field.name, core::rows_of(field.values, vertices)});
    for (const Field& field : surface.cell_fields)
        if (is_kept(field)) out.cell_fields.push_back({field.name, core::rows_of(field.values, left.like)});
    return out;
}

std::vector<std::string> left_out_of(const Surface& surface) {
    std::vector<std::string> names;
    for (const Field& field : surface.cell_fields)
        if (!is_kept(field)) names.push_back(field.name);
    if (!surface.edge_ends.empty()) names.emplace_back("edge_ends");
    if (!surface.source_cells.empty()) names.emplace_back("source_cells");
    return names;
}

/// Normals that follow the triangles.
Result<void> renew_normals(Surface& out, Normals kind, const Run& run) {
    if (kind != Normals::vertex && kind != Normals::face) return {};
    Result<Array> normals = kind == Normals::vertex ? vertex_normals(out, run) : face_normals(out, run);
    if (!normals) return normals.error();
    out.normals_kind = kind;
    out.normals = *std::move(normals);
    return {};
}

Result<ReducedSurface> reduced(const Surface& surface, const ReduceOptions& options, const Progress& progress) {
    const Result<Mesh> mesh = Mesh::open(surface);
    if (!mesh) return mesh.error();
    if (auto enough = core::require_memory("reducing a surface", bytes_a_triangle * surface.triangle_count()); !enough)
        return enough.error();
    ReducedSurface out;
    out.triangles_before = surface.triangle_count();
    out.left_out = left_out_of(surface);
    const std::vector<TriangleGroup> groups = triangle_groups(surface, kept_fields, progress);
    std::vector<Piece> pieces;
    PieceMaker piece_of(*mesh, progress);
    for (const TriangleGroup& group : groups) pieces.push_back(piece_of(group.triangles));
    const Error stopped{ErrorCode::cancelled, "reducing a surface was cancelled"};
    if (progress.cancelled()) return stopped;
    const Goals goals(pieces, options, progress);
    Left left;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        const Simplified simplified = simplify(pieces[i], goals[i].wanted, goals[i].limit, progress);
        if (progress.cancelled()) return stopped;
        out.error = std::max(out.error, simplified.error);
        for (const unsigned index : simplified.indices) left.corners.push_back(pieces[i].vertices[index]);
        left.like.insert(left.like.end(), simplified.triangles(), groups[i].triangles.front());
        progress("reduce", static_cast<double>(i + 1) / static_cast<double>(pieces.size()));
    }
    cancel_double_sheets(left, progress);
    out.surface = surface_of(surface, left, progress);
    if (progress.cancelled()) return stopped;
    return out;
}

} // namespace
} // namespace checking

Result<ReducedSurface> reduce(const Surface& surface, const ReduceOptions& options, const Run& run) {
    if (!(options.share >= 0 && options.share < 1))
        return invalid_argument(
            fmt::format("the share of triangles that may go is {}, but must be from 0 to below 1", options.share));
    if (!(options.error >= 0))
        return invalid_argument(fmt::format("the error is {}, but must be 0 or more", options.error));
    if (surface.vertex_count() > std::numeric_limits<std::uint32_t>::max())
        return invalid_argument(fmt::format("the surface has {} vertices, but must have fewer than 2^32 to be reduced",
                                            surface.vertex_count()));
    Result<ReducedSurface> out = core::carry_out("reducing a surface", run, [&](const Progress& progress) {
        return checking::reduced(surface, options, progress);
    });
    if (!out) return out;
    if (auto renewed = checking::renew_normals(out->surface, surface.normals_kind, run); !renewed)
        return renewed.error();
    return out;
}

} // namespace isotet
