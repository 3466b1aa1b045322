// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "grid/mixed_faces.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <vector>

#include <tbb/enumerable_thread_specific.h>

#include "base/parallel.hpp"
#include "grid/cell/native_cells.hpp"

namespace isotet::core {

namespace {

using Quad = std::array<std::uint64_t, 4>; ///< points, ascending
using Triangle = std::array<std::uint64_t, 3>;

struct Faces {
    std::vector<Quad> quads;
    std::vector<Triangle> triangles;
};

constexpr std::size_t bucket_count = 128;
using Buckets = std::array<Faces, bucket_count>; ///< by a hash of the lowest point
using BucketsOfThreads = tbb::enumerable_thread_specific<Buckets>;

template <class Face>
std::vector<Face> sorted(BucketsOfThreads& parts, std::size_t bucket, std::vector<Face> Faces::* member) {
    std::vector<Face> all;
    for (Buckets& part : parts) {
        all.insert(all.end(), (part[bucket].*member).begin(), (part[bucket].*member).end());
        part[bucket].*member = {};
    }
    std::ranges::sort(all);
    return all;
}

/// The points of a face, ascending, each once.
struct FacePoints {
    std::array<std::uint64_t, 4> points{};
    std::size_t count = 0;

    void add(std::uint64_t point) {
        std::size_t at = count;
        while (at > 0 && points[at - 1] > point) --at;
        if (at > 0 && points[at - 1] == point) return;
        for (std::size_t k = count++; k > at; --k) points[k] = points[k - 1];
        points[at] = point;
    }
};

/// Calls f(face) for each face of a cell.
template <class F>
void for_faces(const CellReader& cells, std::size_t cell, const F& f) {
    for (const WholeCell& part : native_parts(cells.whole(cell)))
        for (const CellFace& face : shape_of(part.kind).faces()) {
            FacePoints points;
            for (const std::uint8_t corner : face.all()) points.add(part.corners[corner]);
            f(points);
        }
}

/// The faces whose lowest point is of one share of all points, by a hash.
void deal_share(const CellReader& cells, std::uint64_t share, std::uint64_t shares, const Progress& progress,
                BucketsOfThreads& parts) {
    parallel_pieces(cells.count(), 1 << 14, progress, [&](std::size_t begin, std::size_t end) {
        Buckets& out = parts.local();
        for (std::size_t cell = begin; cell < end; ++cell) {
            if (!is_contoured(cells.type(cell))) continue;
            for_faces(cells, cell, [&](const FacePoints& face) {
                const auto& p = face.points;
                const std::uint64_t hash = p[0] * 0x9e3779b97f4a7c15u >> 32;
                if (hash % shares != share) return;
                Faces& bucket = out[hash / shares % bucket_count];
                if (face.count == 4) bucket.quads.push_back(p);
                else if (face.count == 3) bucket.triangles.push_back({p[0], p[1], p[2]});
            });
        }
    });
}

/// A face that has three corners of a quadrilateral, its lowest among them; where two triangles meet it, one has.
bool meets_triangle(const Quad& quad, const std::vector<Triangle>& triangles) {
    const auto [a, b, c, d] = quad;
    for (const Triangle& half : {Triangle{a, b, c}, Triangle{a, b, d}, Triangle{a, c, d}})
        if (std::ranges::binary_search(triangles, half)) return true;
    return false;
}

} // namespace

std::uint64_t count_quads_on_triangles(const CellReader& cells, std::uint64_t memory, const Progress& progress) {
    if (cells.only_tets()) return 0;
    std::array<bool, cell_kind_count> kinds{};
    for (std::size_t cell = 0; cell < cells.count(); ++cell)
        if (const auto kind = kind_of(cells.type(cell))) kinds[static_cast<std::size_t>(*kind)] = true;
    const auto has = [&](CellKind kind) { return kinds[static_cast<std::size_t>(kind)]; };
    const bool quads = has(CellKind::pyramid) || has(CellKind::wedge) || has(CellKind::hexahedron);
    const bool triangles = has(CellKind::pyramid) || has(CellKind::wedge) || has(CellKind::tetrahedron);
    if (!quads || !triangles) return 0;

    const std::uint64_t bytes = 6 * cells.count() * sizeof(Quad) * 2;
    const std::uint64_t shares = 1 + bytes / std::max<std::uint64_t>(memory, 1 << 20);
    std::atomic<std::uint64_t> count = 0;
    for (std::uint64_t share = 0; share < shares && !progress.cancelled(); ++share) {
        BucketsOfThreads parts;
        deal_share(cells, share, shares, progress, parts);
        parallel_pieces(bucket_count, 1, progress, [&](std::size_t bucket, std::size_t) {
            const auto all = sorted(parts, bucket, &Faces::quads);
            const auto of_three = sorted(parts, bucket, &Faces::triangles);
            std::uint64_t found = 0;
            for (std::size_t i = 0; i < all.size();) {
                std::size_t next = i + 1;
                while (next < all.size() && all[next] == all[i]) ++next;
                if (next == i + 1) found += meets_triangle(all[i], of_three);
                i = next;
            }
            count += found;
        });
    }
    return progress.cancelled() ? 0 : count.load();
}

} // namespace isotet::core
