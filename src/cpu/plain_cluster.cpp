// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "cpu/plain_cluster.hpp"

#include <atomic>

#include "core/arithmetic.hpp"
#include "core/local_values.hpp"
#include "cpu/level.hpp"
#include "cpu/simd_avx2.hpp"
#include "cpu/simd_avx512.hpp"

namespace isotet::cpu {

namespace {

constexpr std::size_t points = PlainScratch::points;

EdgeKey key_of(core::SeamEdge edge) { return static_cast<EdgeKey>(edge.lower * points + edge.higher); }

void prefetch(const void* address) { __builtin_prefetch(address); }

void prefetch_bytes(const void* first, std::size_t bytes) {
    for (std::size_t at = 0; at < bytes; at += 64) prefetch(static_cast<const std::byte*>(first) + at);
}

/// Asks for what the next cluster will read, while this one is worked on: waiting for memory is what costs most.
void prefetch_cluster(const Packed& packed, const Selection& selection, std::size_t place) {
    if (place + 2 < selection.clusters.size()) prefetch(&packed.headers[selection.clusters[place + 2]]);
    if (place + 1 >= selection.clusters.size()) return;
    const core::ClusterHeader& h = packed.headers[selection.clusters[place + 1]];
    prefetch_bytes(packed.links.data() + h.first_link, 4 * core::ClusterLinks::words(h));
    prefetch_bytes(packed.tets.data() + core::group_size * std::size_t{h.first_group}, sizeof(core::StoredTet) * h.tets);
    prefetch_bytes(packed.as<float>().values.data() + h.first_point, sizeof(float) * h.own_points);
}

void load(const Packed& packed, const core::ClusterHeader& h, const core::ClusterLinks& links, PlainScratch& s) {
    const float* values = packed.as<float>().values.data();
    core::for_foreign_points(packed, links, [&](std::size_t local, std::uint64_t point) {
        s.packed_points[local] = point;
        s.values[local] = values[point];
    });
    std::memcpy(s.values.data() + h.foreign_points, values + h.first_point, sizeof(float) * h.own_points);
    for (std::size_t k = 0; k < h.own_points; ++k) s.packed_points[h.foreign_points + k] = h.first_point + k;
}

template <class Simd>
void cut_tets(const Packed& packed, std::size_t cluster, float isovalue, PlainScratch& s) {
    const core::ClusterHeader& h = packed.headers[cluster];
    const core::StoredTet* tets = packed.tets.data() + core::group_size * std::size_t{h.first_group};
    const core::GroupRange* groups = packed.group_ranges.data() + h.first_group;
    const std::uint8_t step = core::quantize(isovalue, packed.as<float>().ranges[cluster]);
    s.cut.count = 0;
    for (std::size_t first = 0; first < h.tets; first += core::group_size, ++groups)
        if (groups->lower <= step && step <= groups->upper)
            Simd::cut(s.above.data(), tets + first, std::min<std::size_t>(core::group_size, h.tets - first), first, s.cut);
    Simd::keys(s.cut, s.keys.data());
}

void add_edge(PlainScratch& s, EdgeKey key) { s.edges[key / 64] |= std::uint64_t{1} << key % 64; }
void remove_edge(PlainScratch& s, EdgeKey key) { s.edges[key / 64] &= ~(std::uint64_t{1} << key % 64); }

/// Own seams into `own` and the mask, foreign ones into `foreign`; what remains in the matrix are inner edges.
template <class Simd>
void sort_out_seams(const Packed& packed, const core::ClusterLinks& links, const Selection& selection, Masks& masks,
                    std::size_t place, PlainScratch& s) {
    std::uint64_t* const mask = masks.seams(place);
    Simd::template crossed<2>(s.above.data(), reinterpret_cast<const std::uint8_t*>(links.own_seams.data()), links.own_seams.size(), mask);
    core::for_bits(mask, core::words_of_bits(links.own_seams.size()), [&](std::size_t k) {
        const EdgeKey key = key_of(links.own_seams[k]);
        remove_edge(s, key);
        s.own.push_back(key);
    });
    Simd::template crossed<4>(s.above.data(), reinterpret_cast<const std::uint8_t*>(links.foreign_seams.data()),
                              links.foreign_seams.size(), s.crossed_seams.data());
    // Crossed foreign seams ascend, and so do the neighbours' parts of the list.
    std::size_t neighbour = 0, end = links.neighbours.empty() ? 0 : links.neighbours[0].foreign_seams;
    core::for_bits(s.crossed_seams.data(), core::words_of_bits(links.foreign_seams.size()), [&](std::size_t k) {
        while (k >= end) end += links.neighbours[++neighbour].foreign_seams;
        const std::uint32_t owner = links.neighbours[neighbour].cluster;
        const core::ForeignSeam seam = links.foreign_seams[k];
        const EdgeKey key = key_of(seam.edge);
        remove_edge(s, key);
        s.foreign.push_back({selection.place[owner], seam.index});
        s.foreign_keys.push_back(key);
        if (packed.has_no_data[owner])
            std::atomic_ref<std::uint64_t>(masks.seams(selection.place[owner])[seam.index / 64])
                .fetch_or(std::uint64_t{1} << seam.index % 64, std::memory_order_relaxed);
    });
}

/// Appends the inner edges, ascending, and empties the matrix.
template <class Simd>
void take_inner_edges(PlainScratch& s) {
    std::array<std::uint64_t, points * points / 4096> words;
    Simd::nonzero(s.edges.data(), s.edges.size(), words.data());
    core::for_bits(words.data(), words.size(), [&](std::size_t word) {
        for (std::uint64_t bits = s.edges[word]; bits; bits &= bits - 1)
            s.own.push_back(static_cast<EdgeKey>(64 * word + static_cast<std::size_t>(std::countr_zero(bits))));
        s.edges[word] = 0;
    });
}

/// Asks for the positions that write_vertices() will read.
void prefetch_positions(const Packed& packed, const PlainScratch& s) {
    const float* const positions = packed.as<float>().positions.data();
    for (const EdgeKey key : s.own) {
        prefetch(positions + 3 * s.packed_points[key / points]);
        prefetch(positions + 3 * s.packed_points[key % points]);
    }
}

Record* make_record(const Request<float>& request, std::uint32_t triangles, PlainScratch& s) {
    const std::size_t own = s.own.size(), foreign = s.foreign.size();
    // Triangles are written two at a time: room for one too many.
    std::size_t bytes = sizeof(Record) + 12 * own + sizeof(ForeignVertex) * foreign + 6 * (triangles + 1u);
    bytes = (bytes + 3) / 4 * 4;
    Record header{static_cast<std::uint32_t>(own), static_cast<std::uint32_t>(foreign), triangles, 0, 0, 0};
    const auto reserve = [&](std::uint32_t& at, std::size_t size) {
        at = static_cast<std::uint32_t>(bytes);
        bytes += (size + 3) / 4 * 4;
    };
    if (request.ends || request.normals) {
        reserve(header.weights_at, sizeof(float) * own);
        reserve(header.ends_at, sizeof(EndPair) * own);
    }
    if (request.source_cells) reserve(header.tets_at, 2 * (triangles + 1u));
    return new (s.arena.take(bytes)) Record(header);
}

void write_vertices(const Packed& packed, const Request<float>& request, const PlainScratch& s, Record& record) {
    const float* const positions = packed.as<float>().positions.data();
    float* out = record.positions();
    for (std::size_t i = 0; i < s.own.size(); ++i, out += 3) {
        std::size_t below = s.own[i] / points, above = s.own[i] % points;
        if (s.above[below]) std::swap(below, above);
        const float t = core::edge_weight(request.isovalues.front(), s.values[below], s.values[above]);
        const float* const a = positions + 3 * s.packed_points[below];
        const float* const b = positions + 3 * s.packed_points[above];
        for (std::size_t axis = 0; axis < 3; ++axis) out[axis] = core::interpolate(a[axis], b[axis], t);
        if (record.ends_at) {
            record.weights()[i] = t;
            record.ends()[i] = {static_cast<std::uint8_t>(below), static_cast<std::uint8_t>(above)};
        }
    }
}

void write_triangles(const PlainScratch& s, Record& record) {
    std::uint16_t* out = record.corners();
    std::uint16_t* tet = record.tets_at ? record.tets() : nullptr;
    const EdgeKey* key = s.keys.data();
    for (std::size_t i = 0; i < s.cut.count; ++i, key += 4) {
        const std::uint16_t a = s.numbers[key[0]], b = s.numbers[key[1]], c = s.numbers[key[2]], d = s.numbers[key[3]];
        const std::uint16_t corners[6] = {a, b, c, a, c, d};
        std::memcpy(out, corners, sizeof corners);
        const std::size_t triangles = core::case_table[s.cut.cases[i]].triangles;
        out += 3 * triangles;
        if (tet) {
            tet[0] = tet[1] = s.cut.places[i];
            tet += triangles;
        }
    }
}

template <class Simd>
const Record* cut_plain(const Packed& packed, const Request<float>& request, const Selection& selection, Masks& masks,
                        std::size_t place, PlainScratch& s, Count& count) {
    const std::size_t cluster = selection.clusters[place];
    const core::ClusterHeader& h = packed.headers[cluster];
    const core::ClusterLinks links = packed.cluster_links(cluster);
    prefetch_cluster(packed, selection, place);
    load(packed, h, links, s);
    if (Simd::classify(s.values.data(), std::size_t{h.foreign_points} + h.own_points, request.isovalues.front(), s.above.data())) return nullptr;
    cut_tets<Simd>(packed, cluster, request.isovalues.front(), s);
    for (std::size_t i = 0; i < 4 * s.cut.count; ++i) add_edge(s, s.keys[i]);
    std::uint32_t triangles = 0;
    for (std::size_t i = 0; i < s.cut.count; ++i) triangles += core::case_table[s.cut.cases[i]].triangles;

    s.own.clear();
    s.foreign.clear();
    s.foreign_keys.clear();
    sort_out_seams<Simd>(packed, links, selection, masks, place, s);
    const std::size_t seams = s.own.size();
    take_inner_edges<Simd>(s);
    prefetch_positions(packed, s);
    count = {static_cast<std::uint32_t>(s.own.size() - seams), triangles};

    std::uint16_t number = 0;
    for (const EdgeKey key : s.own) s.numbers[key] = number++;
    for (const EdgeKey key : s.foreign_keys) s.numbers[key] = number++;
    Record* const record = make_record(request, triangles, s);
    write_vertices(packed, request, s, *record);
    std::copy(s.foreign.begin(), s.foreign.end(), record->foreign_vertices());
    write_triangles(s, *record);
    return record;
}

#if defined(__x86_64__)
// Everything is inlined into these, and so compiled for their instruction set.
[[gnu::target("avx512f,avx512bw,avx512vl,avx512vbmi,bmi,bmi2,popcnt"), gnu::flatten]] const Record*
cut_plain_avx512(const Packed& packed, const Request<float>& request, const Selection& selection, Masks& masks, std::size_t place,
                 PlainScratch& s, Count& count) {
    return cut_plain<Avx512>(packed, request, selection, masks, place, s, count);
}
[[gnu::target("avx2,bmi,bmi2,popcnt"), gnu::flatten]] const Record*
cut_plain_avx2(const Packed& packed, const Request<float>& request, const Selection& selection, Masks& masks, std::size_t place,
               PlainScratch& s, Count& count) {
    return cut_plain<Avx2>(packed, request, selection, masks, place, s, count);
}
#endif

} // namespace

const Record* cut_plain_cluster(const Packed& packed, const Request<float>& request, const Selection& selection, Masks& masks,
                                std::size_t place, PlainScratch& s, Count& count) {
    switch (level()) {
#if defined(__x86_64__)
    case Level::avx512: return cut_plain_avx512(packed, request, selection, masks, place, s, count);
    case Level::avx2: return cut_plain_avx2(packed, request, selection, masks, place, s, count);
#endif
    default: return cut_plain<Portable>(packed, request, selection, masks, place, s, count);
    }
}

} // namespace isotet::cpu
