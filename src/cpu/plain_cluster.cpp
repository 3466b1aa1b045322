// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The fast path: clusters of single precision where no local point is tied or without data. There a cluster knows by itself
// all of its vertices.
#include <atomic>

#include "cpu/cutting.hpp"
#include "cpu/level.hpp"
#include "cpu/simd_avx2.hpp"
#include "cpu/simd_avx512.hpp"

namespace isotet::cpu {

namespace {

using Scratch = CutScratch<float>;

template <class Simd>
void cut_tets(const Packed& packed, std::size_t cluster, float isovalue, Scratch& s) {
    const core::ClusterHeader& h = packed.headers[cluster];
    const core::StoredTet* tets = packed.tets.data() + core::group_size * std::size_t{h.first_group};
    const core::GroupRange* groups = packed.group_ranges.data() + h.first_group;
    const std::uint8_t step = core::quantize(isovalue, packed.as<float>().ranges[cluster]);
    s.cut.count = 0;
    for (std::size_t first = 0; first < h.tets; first += core::group_size, ++groups)
        if (groups->lower <= step && step <= groups->upper)
            Simd::cut(s.above.data(), tets + first, std::min<std::size_t>(core::group_size, h.tets - first), first,
                      s.cut);
    Simd::keys(s.cut, s.keys.data());
}

/// Own seams into `listed` and the mask, foreign ones into `shared`; what remains are inner edges.
template <class Simd>
void sort_out_seams(const Cutting<float>& cutting, const core::ClusterLinks& links, std::size_t place, Scratch& s) {
    std::uint64_t* const mask = cutting.masks.seams(place);
    Simd::template crossed<2>(s.above.data(), reinterpret_cast<const std::uint8_t*>(links.own_seams.data()),
                              links.own_seams.size(), mask);
    core::for_bits(mask, core::words_of_bits(links.own_seams.size()), [&](std::size_t k) {
        const VertexKey key = edge_key(links.own_seams[k]);
        s.take_out(key);
        s.listed.push_back(key);
    });
    Simd::template crossed<4>(s.above.data(), reinterpret_cast<const std::uint8_t*>(links.foreign_seams.data()),
                              links.foreign_seams.size(), s.crossed_seams.data());
    // Crossed foreign seams ascend, and so do the neighbours' parts of the list.
    const std::uint32_t isovalue = cutting.selection.isovalues[place];
    std::size_t neighbour = 0, end = links.neighbours.empty() ? 0 : links.neighbours[0].foreign_seams;
    core::for_bits(s.crossed_seams.data(), core::words_of_bits(links.foreign_seams.size()), [&](std::size_t k) {
        while (k >= end) end += links.neighbours[++neighbour].foreign_seams;
        const std::uint32_t cluster = links.neighbours[neighbour].cluster;
        const core::ForeignSeam seam = links.foreign_seams[k];
        const std::size_t owner = cutting.selection.place(cluster, isovalue);
        s.share(edge_key(seam.edge), {static_cast<std::uint32_t>(owner), seam.index});
        if (cutting.packed.has_no_data[cluster]) cutting.masks.set_seam(owner, seam.index);
    });
}

/// Appends the inner edges, ascending, and empties the matrix.
template <class Simd>
void take_inner_edges(Scratch& s) {
    std::array<std::uint64_t, Scratch::points * Scratch::points / 4096> words;
    Simd::nonzero(s.used.data(), s.used.size(), words.data());
    core::for_bits(words.data(), words.size(), [&](std::size_t word) {
        for (std::uint64_t bits = s.used[word]; bits; bits &= bits - 1)
            s.listed.push_back(static_cast<VertexKey>(64 * word + static_cast<std::size_t>(std::countr_zero(bits))));
        s.used[word] = 0;
    });
}

void write_triangles(const Scratch& s, Record<float>& record) {
    std::uint16_t* out = record.corners();
    std::uint16_t* tet = record.has_tets ? record.tets() : nullptr;
    const VertexKey* key = s.keys.data();
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
const Record<float>* cut_plain(const Cutting<float>& cutting, std::size_t place, Scratch& s, Start& count) {
    static constexpr Record<float> nothing;
    const std::size_t cluster = cutting.selection.clusters[place];
    const core::ClusterHeader& h = cutting.packed.headers[cluster];
    const float isovalue = cutting.wanted.isovalues[cutting.selection.isovalues[place]];
    if (Simd::classify(s.values.data(), std::size_t{h.foreign_points} + h.own_points, isovalue, s.above.data()))
        return nullptr;
    cut_tets<Simd>(cutting.packed, cluster, isovalue, s);
    for (std::size_t i = 0; i < 4 * s.cut.count; ++i) s.use(s.keys[i]);
    std::size_t triangles = 0;
    for (std::size_t i = 0; i < s.cut.count; ++i) triangles += core::case_table[s.cut.cases[i]].triangles;

    s.listed.clear();
    s.shared.clear();
    s.shared_keys.clear();
    sort_out_seams<Simd>(cutting, cutting.packed.cluster_links(cluster), place, s);
    const std::size_t seams = s.listed.size();
    take_inner_edges<Simd>(s);
    count = {s.listed.size() - seams, triangles};
    if (s.listed.empty() && triangles == 0) return &nothing;

    number_vertices(s);
    Record<float>& record = begin_record(isovalue, triangles, cutting.wanted.source_cells, s);
    write_triangles(s, record);
    return &record;
}

#if defined(__x86_64__)
// Everything is inlined into these, and so compiled for their instruction set.
[[gnu::target("avx512f,avx512bw,avx512vl,avx512vbmi,bmi,bmi2,popcnt"), gnu::flatten]] const Record<float>*
cut_plain_avx512(const Cutting<float>& cutting, std::size_t place, Scratch& s, Start& count) {
    return cut_plain<Avx512>(cutting, place, s, count);
}
[[gnu::target("avx2,bmi,bmi2,popcnt"), gnu::flatten]] const Record<float>*
cut_plain_avx2(const Cutting<float>& cutting, std::size_t place, Scratch& s, Start& count) {
    return cut_plain<Avx2>(cutting, place, s, count);
}
#endif

} // namespace

const Record<float>* cut_plain_cluster(const Cutting<float>& cutting, std::size_t place, Scratch& s, Start& count) {
    switch (level()) {
#if defined(__x86_64__)
    case Level::avx512: return cut_plain_avx512(cutting, place, s, count);
    case Level::avx2: return cut_plain_avx2(cutting, place, s, count);
#endif
    default: return cut_plain<Portable>(cutting, place, s, count);
    }
}

} // namespace isotet::cpu
