// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "cpu/direct/weld.hpp"

#include <algorithm>
#include <utility>

#include <tbb/enumerable_thread_specific.h>

#include "base/workers.hpp"

namespace isotet::cpu::direct {

namespace {

template <class Point>
void count_up(std::vector<Chunk<Point>>& chunks) {
    std::uint64_t edges = 0, triangles = 0;
    for (Chunk<Point>& chunk : chunks) {
        edges += std::exchange(chunk.edges, edges);
        triangles += std::exchange(chunk.triangles, triangles);
    }
}

/// Gives every cutter its own places within each range; returns where the ranges begin.
template <class Point>
std::vector<std::uint64_t> place_ranges(CutCells<Point>& cut, std::size_t count) {
    std::vector<std::uint64_t> first(count + 1);
    std::uint64_t next = 0;
    for (std::size_t range = 0; range < count; ++range) {
        first[range] = next;
        for (const auto& cutter : cut.cutters)
            next += std::exchange(cutter->in_range()[range], static_cast<Point>(next));
    }
    first[count] = next;
    return first;
}

/// Moves the edges that one cutter found into their ranges, and gives back its memory for them.
template <class Point>
void scatter(const CutCells<Point>& cut, std::size_t cutter, const Ranges& ranges, FoundEdge<Point>* out) {
    Point* const places = cut.cutters[cutter]->in_range().data();
    for (const Chunk<Point>& chunk : cut.chunks) {
        if (chunk.cutter != cutter) continue;
        auto number = static_cast<Point>(chunk.edges);
        for (const Piece<Point>& piece : chunk.pieces)
            for (std::uint32_t i = 0; i < piece.edges; ++i) {
                const ActiveEdge<Point> edge = piece.found[i];
                out[places[ranges.of(edge.lower)]++] = {edge, number++};
            }
    }
    cut.cutters[cutter]->drop_found();
}

/// One thread's memory for sorting.
template <class Point>
struct Scratch {
    std::vector<std::uint32_t> places;
    std::vector<FoundEdge<Point>> edges;
};

/// Sorts the edges of one range, whose lowest point is `base`, by their ends.
template <class Point>
void sort_range(FoundEdge<Point>* edges, std::size_t count, std::uint64_t base, std::size_t points,
                Scratch<Point>& scratch) {
    const auto comes_before = [](const FoundEdge<Point>& a, const FoundEdge<Point>& b) {
        return a.edge.lower != b.edge.lower ? a.edge.lower < b.edge.lower : a.edge.higher < b.edge.higher;
    };
    if (count < points / 16) return std::sort(edges, edges + count, comes_before);
    // By lower end, counting; the few edges from one point then by insertion, where they are not few by sorting.
    constexpr std::uint32_t few = 32;
    std::vector<std::uint32_t>& places = scratch.places;
    places.assign(points + 1, 0);
    std::uint32_t most = 0; // from one point
    for (std::size_t i = 0; i < count; ++i) most = std::max(most, ++places[edges[i].edge.lower - base + 1]);
    for (std::size_t p = 0; p < points; ++p) places[p + 1] += places[p];
    if (scratch.edges.size() < count) scratch.edges.resize(count);
    FoundEdge<Point>* const by_lower = scratch.edges.data();
    for (std::size_t i = 0; i < count; ++i) by_lower[places[edges[i].edge.lower - base]++] = edges[i];
    if (most > few)
        for (std::size_t p = 0, begin = 0; p < points; begin = places[p++]) // places are ends now
            if (places[p] - begin > few) std::sort(by_lower + begin, by_lower + places[p], comes_before);
    for (std::size_t i = 0; i < count; ++i) {
        std::size_t to = i;
        for (; to > 0 && comes_before(by_lower[i], edges[to - 1]); --to) edges[to] = edges[to - 1];
        edges[to] = by_lower[i];
    }
}

} // namespace

template <class Point>
Welded<Point> weld(CutCells<Point>& cut, const Ranges& ranges) {
    count_up(cut.chunks);
    Welded<Point> out;
    out.first_edge = place_ranges(cut, ranges.count);
    out.edges = core::Buffer<FoundEdge<Point>>(out.first_edge.back());
    core::worker_each(cut.cutters.size(), 1,
                        [&](std::size_t cutter) { scatter(cut, cutter, ranges, out.edges.data()); });

    out.first_vertex.assign(ranges.count + 1, 0);
    tbb::enumerable_thread_specific<Scratch<Point>> scratch;
    core::worker_each(ranges.count, 1, [&](std::size_t range) {
        FoundEdge<Point>* const edges = out.edges.data() + out.first_edge[range];
        const auto count = static_cast<std::size_t>(out.first_edge[range + 1] - out.first_edge[range]);
        if (count == 0) return;
        sort_range(edges, count, std::uint64_t{range} << ranges.shift, std::size_t{1} << ranges.shift, scratch.local());
        std::uint64_t different = 1;
        for (std::size_t i = 1; i < count; ++i) different += edges[i].edge != edges[i - 1].edge;
        out.first_vertex[range + 1] = different;
    });
    for (std::size_t range = 0; range < ranges.count; ++range) out.first_vertex[range + 1] += out.first_vertex[range];
    return out;
}

template Welded<std::uint32_t> weld<std::uint32_t>(CutCells<std::uint32_t>&, const Ranges&);
template Welded<std::uint64_t> weld<std::uint64_t>(CutCells<std::uint64_t>&, const Ranges&);

} // namespace isotet::cpu::direct
