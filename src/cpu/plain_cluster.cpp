// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The fast path: clusters of single precision where no local point is tied or without data. There a cluster knows by
// itself all of its vertices.
#include <atomic>

#include "cpu/cutting.hpp"
#include "cpu/level.hpp"
#include "cpu/simd_avx2.hpp"
#include "cpu/simd_avx512.hpp"

namespace isotet::cpu {

namespace {

using Scratch = CutScratch<float>;

/// The groups of a cluster, one after another.
struct Groups {
    const core::StoredTet* const words; ///< of the cluster
    const core::GroupRange* const ranges;
    const std::uint8_t step; ///< the isovalue in steps of the cluster's range
    std::size_t next = 0;

    /// Calls f(words, cells, first word) for those of the next `count` cells, `size` a group, that may be cut.
    template <class F>
    void for_hit(std::size_t count, std::size_t size, const F& f) {
        for (std::size_t first = 0; first < count; first += size, ++next)
            if (ranges[next].lower <= step && step <= ranges[next].upper)
                f(words + core::group_size * next, std::min(size, count - first), core::group_size * next);
    }
};

template <class Simd, core::CellKind kind>
void cut_cells(std::size_t count, Groups& groups, Scratch& s) {
    if (count == 0) return;
    s.cells.count = 0;
    groups.for_hit(count, core::cells_per_group(kind),
                   [&](const core::StoredTet* words, std::size_t n, std::size_t first) {
                       Simd::template cut_cells<kind>(s.above.data(), words, n, first, s.cells);
                   });
    Simd::template polygons<kind>(s.cells, s.cut, s.keys.data());
}

template <class Simd>
void cut_all(const Packed& packed, std::size_t cluster, float isovalue, Scratch& s) {
    using core::CellKind;
    const core::ClusterHeader& h = packed.headers[cluster];
    Groups groups{packed.cells.data() + packed.first_word(cluster), packed.group_ranges.data() + h.first_group,
                  core::quantize(isovalue, packed.as<float>().ranges[cluster])};
    s.cut.count = 0;
    groups.for_hit(h.tets(), core::group_size, [&](const core::StoredTet* tets, std::size_t n, std::size_t first) {
        Simd::cut(s.above.data(), tets, n, first, s.cut);
    });
    Simd::keys(s.cut, s.keys.data());
    if (h.others() == 0) return;
    cut_cells<Simd, CellKind::pyramid>(h.count(CellKind::pyramid), groups, s);
    cut_cells<Simd, CellKind::wedge>(h.count(CellKind::wedge), groups, s);
    cut_cells<Simd, CellKind::hexahedron>(h.count(CellKind::hexahedron), groups, s);
}

/// Own seams into `listed` and the mask, ghost ones into `shared`; what remains are inner edges.
template <class Simd>
void sort_out_seams(const Cutting<float>& cutting, const core::ClusterLinks& links, std::size_t place, Scratch& s) {
    s.listed.grow(Simd::cross_own_seams(s.above.data(), links.own_seams, cutting.masks.seams(place), s.listed.end()));
    for (const VertexKey key : s.listed) s.used.take_out(key);

    const std::size_t crossed =
        Simd::cross_ghost_seams(s.above.data(), links.ghost_seams, s.crossed_seams.data(), s.crossed_places.data());
    // Crossed ghost seams ascend, and so do the neighbours' parts of the list.
    const std::uint32_t isovalue = cutting.selection.isovalues[place];
    const core::Neighbour* neighbour = links.neighbours.data();
    std::size_t end = crossed ? neighbour->ghost_seams : 0;
    for (std::size_t i = 0; i < crossed; ++i) {
        while (s.crossed_places[i] >= end) end += (++neighbour)->ghost_seams;
        const core::GhostSeam seam = s.crossed_seams[i];
        const std::size_t owner = cutting.selection.place(neighbour->cluster, isovalue);
        s.share(edge_key(seam.edge), {static_cast<std::uint32_t>(owner), seam.index});
        if (cutting.packed.has_no_data[neighbour->cluster]) cutting.masks.set_seam(owner, seam.index);
    }
}

template <class Number>
void write_triangles(const Scratch& s, const Number* numbers, Number* out, std::uint16_t* tet) {
    const VertexKey* key = s.keys.data();
    for (std::size_t i = 0, n = s.cut.count; i < n; ++i, key += 4) {
        const std::uint64_t a = numbers[key[0]], b = numbers[key[1]], c = numbers[key[2]], d = numbers[key[3]];
        if constexpr (sizeof(Number) == 1) {
            const std::uint64_t corners = a | b << 8 | c << 16 | a << 24 | c << 32 | d << 40;
            std::memcpy(out, &corners, sizeof corners);
        } else {
            const std::uint64_t first = a | b << 16 | c << 32 | a << 48;
            const auto rest = static_cast<std::uint32_t>(c | d << 16);
            std::memcpy(out, &first, sizeof first);
            std::memcpy(out + 4, &rest, sizeof rest);
        }
        const std::size_t triangles = s.cut.triangles[i];
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
    const core::StoredIsovalue<float>& isovalue = cutting.wanted.isovalues[cutting.selection.isovalues[place]];
    if (Simd::classify(s.values.data(), std::size_t{h.ghost_points} + h.own_points, isovalue, s.above.data()))
        return nullptr;
    cut_all<Simd>(cutting.packed, cluster, isovalue.value, s);
    for (std::size_t i = 0; i < 4 * s.cut.count; ++i) s.used.use(s.keys[i]);
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
    Simd::cross(s.listed.data(), record.listed, s.above.data(), s.values.data(), isovalue, s.ends.data(),
                s.weights.data());
    ask_for_positions(cutting.packed, s, record);
    with_numbers(s, record, [&](const auto* numbers, auto* corners) {
        write_triangles(s, numbers, corners, record.has_tets ? record.tets() : nullptr);
    });
    write_vertices<Simd>(cutting.packed, s, record);
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
