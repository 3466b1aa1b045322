// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The fast path: clusters of single precision where no local point is tied or without data. There a cluster knows by
// itself all of its vertices.
#include <atomic>

#include "cpu/active_cells.hpp"
#include "cpu/level.hpp"
#include "cpu/simd_avx2.hpp"
#include "cpu/simd_avx512.hpp"

namespace isotet::cpu {

namespace {

using Scratch = CutScratch<float>;

bool some_have_no_data(const Packed& packed, const core::ClusterLinks& links) {
    unsigned some = 0;
    for (const core::Neighbour& neighbour : links.neighbours) some |= packed.has_no_data[neighbour.cluster];
    return some;
}

/// Own seams into `listed` and the mask, ghost ones into `shared`; what remains are inner edges.
template <class Simd>
void sort_out_seams(const Cutting<float>& cutting, const core::ClusterLinks& links, std::size_t place, Scratch& s) {
    s.listed.grow(Simd::cross_seams(s.above.data(), links.own_seams, cutting.masks.seams(place), s.listed.end()));
    for (const VertexKey key : s.listed) s.used.take_out(key);

    s.shared_keys.grow(Simd::cross_seams(s.above.data(), links.ghost_seams, s.crossed.data(), s.shared_keys.end()));
    for (const VertexKey key : s.shared_keys) s.used.take_out(key);
    const Selection& selection = cutting.selection;
    Simd::find_owners(links, s.crossed.data(), selection.base.data(), selection.isovalues[place], s.shared.end());
    s.shared.grow(s.shared_keys.size());
    if (some_have_no_data(cutting.packed, links))
        for (const SharedVertex& vertex : s.shared)
            if (cutting.packed.has_no_data[selection.clusters[vertex.owner]])
                cutting.masks.set_seam(vertex.owner, vertex.index);
}

template <class Simd>
const Record<float>* cut_plain(const Cutting<float>& cutting, std::size_t place, Scratch& s, Start& count) {
    static constexpr Record<float> nothing;
    const std::size_t cluster = cutting.selection.clusters[place];
    const core::ClusterHeader& h = cutting.packed.headers[cluster];
    const core::StoredIsovalue<float>& isovalue = cutting.wanted.isovalues[cutting.selection.isovalues[place]];
    if (Simd::classify(s.values.data(), std::size_t{h.ghost_points} + h.own_points, isovalue, s.above.data()))
        return nullptr;
    cut_all<Simd>(cutting.packed, cluster, isovalue.value, s, KeepAll());
    for (std::size_t i = 0; i < 4 * s.cut.count; ++i) s.used.use(s.keys[i]);
    ask_further_ahead(cutting, place);
    std::size_t triangles = 0;
    for (std::size_t i = 0; i < s.cut.count; ++i) triangles += s.cut.triangles[i];

    s.listed.clear();
    s.shared.clear();
    s.shared_keys.clear();
    sort_out_seams<Simd>(cutting, cutting.packed.cluster_links(cluster), place, s);
    const std::size_t seams = s.listed.size();
    s.listed.grow(Simd::list_keys(s.used, s.listed.end()));
    count = {s.listed.size() - seams, triangles};
    if (s.listed.empty() && triangles == 0) return &nothing;

    Record<float>& record = begin_record(cutting.wanted, triangles, s);
    place_vertices<Simd>(s);
    Simd::cross(s.listed.data(), record.listed, s.above.data(), s.values.data(), isovalue, s.ends.data(),
                s.weights.data());
    keep_vertices(cutting.packed, s, record);
    with_numbers(s, record, [&](const auto* numbers, auto* corners) {
        write_triangles(s, numbers, corners, record.has_tets ? record.tets() : nullptr);
    });
    return &record;
}

#if defined(__x86_64__)
// Everything is inlined into these, and so compiled for their instruction set.
[[gnu::target("avx512f,avx512bw,avx512vl,avx512vbmi,avx512vbmi2,bmi,bmi2,popcnt"), gnu::flatten]] const Record<float>*
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
