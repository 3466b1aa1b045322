// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "cpu/direct/emit.hpp"

#include <array>

#include "base/workers.hpp"

namespace isotet::cpu::direct {

namespace {

constexpr std::size_t ranges_per_task = 4;

template <class Real>
struct Target {
    Real* positions;
    std::int64_t* ends = nullptr;
    Real* weights = nullptr;
};

template <class Real>
void make_vertex(const VertexSource<Real>& source, std::uint64_t vertex, std::uint64_t lower, std::uint64_t higher,
                 const Target<Real>& target) {
    const std::array<std::uint64_t, 2> ends{lower, higher};
    const std::array<Real, 2> values{source.value(lower), source.value(higher)};
    // Which end is above is a toss: an index costs less than a branch.
    const std::size_t up = values[0] >= source.isovalue().value ? 0 : 1;
    const std::uint64_t below = ends[1 - up], above = ends[up];
    const Real t = lower == higher ? Real(0) : core::edge_weight(source.isovalue(), values[1 - up], values[up]);
    const auto a = source.position(below), b = source.position(above);
    for (std::size_t axis = 0; axis < 3; ++axis)
        target.positions[3 * vertex + axis] = core::interpolate(a[axis], b[axis], t);
    if (!target.ends) return;
    target.ends[2 * vertex] = static_cast<std::int64_t>(below);
    target.ends[2 * vertex + 1] = static_cast<std::int64_t>(above);
    target.weights[vertex] = t;
}

/// Makes the vertices and tells the number of each to all edges that were found there.
template <class Real, class Point, class Index>
void number_edges(const VertexSource<Real>& source, const Welded<Point>& welded, const Target<Real>& target,
                  Index* numbers, const Progress& progress) {
    constexpr std::uint64_t ahead =
        24; // edges: what is read while a higher end is waited for; lower ends follow each other
    core::worker_ranges(welded.first_edge.size() - 1, ranges_per_task, [&](std::size_t begin, std::size_t end) {
        if (progress.cancelled()) return;
        std::uint64_t vertex = welded.first_vertex[begin];
        const FoundEdge<Point>* const edges = welded.edges.data();
        const std::uint64_t first = welded.first_edge[begin], last = welded.first_edge[end];
        for (std::uint64_t i = first; i < last; ++i) {
            if (i + ahead < last && edges[i + ahead].edge != edges[i + ahead - 1].edge)
                source.prefetch(edges[i + ahead].edge.higher);
            if (i == first || edges[i].edge != edges[i - 1].edge)
                make_vertex(source, vertex++, edges[i].edge.lower, edges[i].edge.higher, target);
            numbers[edges[i].number] = static_cast<Index>(vertex - 1);
        }
    });
}

template <class Point, class Index>
void emit_triangles(const CutCells<Point>& cut, const Index* numbers, Index* triangles, std::int64_t* source_cells,
                    const Progress& progress) {
    core::worker_each(cut.chunks.size() - 1, 1, [&](std::size_t c) {
        if (progress.cancelled()) return;
        const Chunk<Point>& chunk = cut.chunks[c];
        const Index* const of_chunk = numbers + chunk.edges;
        Index* out = triangles + 3 * chunk.triangles;
        std::int64_t* cell = source_cells ? source_cells + chunk.triangles : nullptr;
        for (const Piece<Point>& piece : chunk.pieces)
            for (std::uint32_t i = 0; i < piece.polygon_count; ++i) {
                const auto& polygon = piece.polygons[i];
                const Index a = of_chunk[polygon[0]], b = of_chunk[polygon[1]], d = of_chunk[polygon[2]];
                *out++ = a, *out++ = b, *out++ = d;
                if (piece.triangles[i] == 2) *out++ = a, *out++ = d, *out++ = of_chunk[polygon[3]];
                for (std::uint8_t t = 0; cell && t < piece.triangles[i]; ++t)
                    *cell++ = static_cast<std::int64_t>(c * cells_per_chunk + piece.cells[i]);
            }
    });
}

} // namespace

template <class Real, class Point>
std::uint64_t emitting_memory(std::uint64_t vertices, std::uint64_t triangles, std::uint64_t edges,
                              const EmitOptions& options) {
    const std::uint64_t index_bytes = options.wide ? 8 : 4;
    return vertices * (3 * sizeof(Real) + (options.ends ? 16 + sizeof(Real) : 0)) +
           triangles * (3 * index_bytes + (options.source_cells ? 8 : 0)) + edges * index_bytes;
}

template <class Real, class Point>
Result<ops::RawSurface> emit(const VertexSource<Real>& source, const CutCells<Point>& cut, Welded<Point> welded,
                             const EmitOptions& options, const Progress& progress) {
    const std::uint64_t vertices = welded.vertex_count(), triangle_count = cut.chunks.back().triangles,
                        edges = cut.chunks.back().edges;
    const auto make = [&]<class T>(core::SharedBuffer<T>& to, SurfaceArray array, std::size_t tuples,
                                   std::size_t components) {
        to = options.slot(array).template make<T>(tuples, components);
    };
    core::SharedBuffer<Real> positions, weights;
    core::SharedBuffer<std::int64_t> ends, source_cells;
    make(positions, SurfaceArray::positions, vertices, 3);
    if (options.ends) {
        make(weights, SurfaceArray::edge_weights, vertices, 1);
        make(ends, SurfaceArray::edge_ends, vertices, 2);
    }
    if (options.source_cells) make(source_cells, SurfaceArray::source_cells, triangle_count, 1);
    Target<Real> target{positions.data()};
    if (options.ends) {
        target.ends = ends.data();
        target.weights = weights.data();
    }

    ops::RawSurface surface;
    const auto emit_with = [&]<class Index>(core::SharedBuffer<Index> triangles) {
        make(triangles, SurfaceArray::triangles, triangle_count, 3);
        core::Buffer<Index> numbers(edges);
        number_edges(source, welded, target, numbers.data(), progress);
        welded = {};
        progress("extract", 0.8);
        emit_triangles(cut, numbers.data(), triangles.data(), options.source_cells ? source_cells.data() : nullptr,
                       progress);
        surface.triangles = std::move(triangles).to_array(3);
    };
    if (options.wide) emit_with(core::SharedBuffer<std::uint64_t>());
    else emit_with(core::SharedBuffer<std::uint32_t>());
    if (progress.cancelled()) return Error{ErrorCode::cancelled, "extraction was cancelled"};

    surface.positions = std::move(positions).to_array(3);
    if (options.ends) {
        surface.ends = std::move(ends).to_array(2);
        surface.weights = std::move(weights).to_array();
    }
    if (options.source_cells) surface.source_cells = std::move(source_cells).to_array();
    return surface;
}

#define ISOTET_EMIT(Real, Point)                                                                                       \
    template std::uint64_t emitting_memory<Real, Point>(std::uint64_t, std::uint64_t, std::uint64_t,                   \
                                                        const EmitOptions&);                                           \
    template Result<ops::RawSurface> emit<Real, Point>(const VertexSource<Real>&, const CutCells<Point>&,              \
                                                       Welded<Point>, const EmitOptions&, const Progress&)
ISOTET_EMIT(float, std::uint32_t);
ISOTET_EMIT(float, std::uint64_t);
ISOTET_EMIT(double, std::uint32_t);
ISOTET_EMIT(double, std::uint64_t);
#undef ISOTET_EMIT

} // namespace isotet::cpu::direct
