// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <atomic>
#include <memory>

#include <tbb/enumerable_thread_specific.h>

#include "core/parallel.hpp"
#include "cpu/cut_cluster.hpp"
#include "cpu/plain_cluster.hpp"
#include "cpu/steps.hpp"

namespace isotet::cpu {

namespace {

void set_shared_bit(std::uint64_t* words, std::size_t i) {
    std::atomic_ref<std::uint64_t>(words[i / 64]).fetch_or(std::uint64_t{1} << i % 64, std::memory_order_relaxed);
}

/// Where all points of its owner have data, every crossed edge of the owner is used, and the owner knows it from the values
/// alone. Elsewhere whoever has a valid tet at the edge tells the owner.
template <class Real>
std::uint32_t count_seams(const Packed& packed, std::size_t cluster, std::size_t place, const Selection& selection, Masks& masks,
                          const CutCluster<Real>& cut) {
    const core::ClusterLinks links = packed.cluster_links(cluster);
    std::uint32_t used = 0;
    const bool own_no_data = packed.has_no_data[cluster];
    std::uint64_t* const own = masks.seams(place);
    for (std::size_t k = 0; k < links.own_seams.size(); ++k) {
        const core::SeamEdge edge = links.own_seams[k];
        if (!own_no_data) {
            if (!cut.is_crossed(edge)) continue;
            core::set_bit(own, k);
            ++used;
        } else if (cut.edges.test(edge)) {
            set_shared_bit(own, k);
            ++used;
        }
    }
    std::size_t k = 0;
    for (const core::Neighbour& neighbour : links.neighbours) {
        const bool tell = packed.has_no_data[neighbour.cluster];
        for (const std::size_t end = k + neighbour.foreign_seams; k < end; ++k) {
            const core::ForeignSeam& seam = links.foreign_seams[k];
            if (!cut.edges.test(seam.edge)) continue;
            ++used;
            if (tell) set_shared_bit(masks.seams(selection.place[neighbour.cluster]), seam.index);
        }
    }
    return used;
}

/// Tells the owners of tied points that triangles of this cluster use them.
template <class Real>
void count_tied(const Packed& packed, std::size_t cluster, std::size_t place, const Selection& selection, Masks& masks,
                const CutCluster<Real>& cut) {
    const core::ClusterHeader& h = packed.headers[cluster];
    const core::ClusterLinks links = packed.cluster_links(cluster);
    std::size_t local = 0;
    for (const core::Neighbour& neighbour : links.neighbours)
        for (const std::size_t end = local + neighbour.foreign_points; local < end; ++local)
            if (core::test_bit(cut.used_tied.data(), local))
                set_shared_bit(masks.tied(selection.place[neighbour.cluster]), links.foreign_points[local]);
    for (; local < cut.points; ++local)
        if (core::test_bit(cut.used_tied.data(), local)) set_shared_bit(masks.tied(place), local - h.foreign_points);
}

/// One thread's memory: the general path for any cluster, the fast one for plain clusters of single precision.
template <class Real>
struct Scratch {
    CutCluster<Real> cut;
    PlainScratch plain;
    std::uint64_t tied_points = 0;
};

template <class Real>
void count_cluster(const Packed& packed, const Request<Real>& request, const Selection& selection, Masks& masks, std::size_t place,
                   Scratch<Real>& scratch, Counted& out) {
    if constexpr (sizeof(Real) == sizeof(float)) {
        out.records[place] = cut_plain_cluster(packed, request, selection, masks, place, scratch.plain, out.counts[place]);
        if (out.records[place]) return;
    } else {
        out.records[place] = nullptr;
    }
    const std::size_t cluster = selection.clusters[place];
    CutCluster<Real>& cut = scratch.cut;
    cut.cut(packed, cluster, request.isovalues.front(), request.ties);
    scratch.tied_points += cut.own_with(request.isovalues.front(), packed.headers[cluster].foreign_points);
    const std::uint32_t seams = count_seams(packed, cluster, place, selection, masks, cut);
    if (cut.has_tied()) count_tied(packed, cluster, place, selection, masks, cut);
    out.counts[place] = {cut.edges.count() - seams, cut.triangles};
}

} // namespace

template <class Real>
Counted count(const Packed& packed, const Request<Real>& request, const Selection& selection, Masks& masks, const Progress& progress) {
    Counted out;
    out.counts = core::Buffer<Count>(selection.clusters.size());
    out.records = core::Buffer<const Record*>(selection.clusters.size());
    using Memory = Scratch<Real>;
    tbb::enumerable_thread_specific<std::shared_ptr<Memory>> scratch([] { return std::make_shared<Memory>(); });
    core::parallel_ranges(selection.clusters.size(), 16, [&](std::size_t begin, std::size_t end) {
        if (progress.cancelled()) return;
        Memory& memory = *scratch.local();
        for (std::size_t place = begin; place < end; ++place)
            count_cluster(packed, request, selection, masks, place, memory, out);
    });
    for (std::shared_ptr<Memory>& memory : scratch) {
        out.record_bytes += memory->plain.arena.bytes();
        out.tied_points += memory->tied_points;
        out.memory.push_back(std::move(memory));
    }
    return out;
}

template Counted count<float>(const Packed&, const Request<float>&, const Selection&, Masks&, const Progress&);
template Counted count<double>(const Packed&, const Request<double>&, const Selection&, Masks&, const Progress&);

core::Buffer<Start> scan(const core::Buffer<Count>& counts, const Masks& masks) {
    core::Buffer<Start> starts(counts.size() + 1);
    core::parallel_each(counts.size(), 1 << 12, [&](std::size_t place) {
        starts[place + 1] = {counts[place].inner_edges + core::count_bits(masks.tied(place), Masks::tied_words) +
                                 core::count_bits(masks.seams(place), masks.seam_words(place)),
                             counts[place].triangles};
    });
    starts[0] = {0, 0};
    for (std::size_t place = 0; place < counts.size(); ++place) {
        starts[place + 1].vertex += starts[place].vertex;
        starts[place + 1].triangle += starts[place].triangle;
    }
    return starts;
}

} // namespace isotet::cpu
