// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <atomic>
#include <memory>
#include <utility>

#include <tbb/enumerable_thread_specific.h>

#include "base/workers.hpp"
#include "cpu/at_level.hpp"
#include "cpu/batches.hpp"
#include "cpu/cutting.hpp"
#include "cpu/level.hpp"
#include "cpu/prefetch.hpp"

namespace isotet::cpu {

namespace {

/// The points and values of clusters; those of the next one are asked for.
template <class Real>
class Loader {
public:
    explicit Loader(const Cutting<Real>& cutting) : cutting_(cutting) {}

    /// Those of the cluster of a place.
    void load(std::size_t place, CutScratch<Real>& s) const {
        const std::size_t cluster = cutting_.selection.clusters[place];
        std::swap(s.local, s.next);
        if (s.next_cluster != cluster) s.local->find(cutting_.packed, cluster);
        ask_for_next(place, s);
        core::load_values(cutting_.packed, cluster, *s.local, s.values.data());
        s.cluster = cluster;
    }

private:
    void ask_for_next(std::size_t place, CutScratch<Real>& s) const {
        const PlacesAhead ahead(cutting_.selection, place);
        if (!ahead.has(0)) return;
        const Packed& packed = cutting_.packed;
        const std::size_t cluster = cutting_.selection.clusters[ahead[0]];
        s.next->find(packed, cluster);
        s.next_cluster = cluster;
        const Real* const values = packed.as<Real>().values.data();
        for (std::size_t k = 0; k < s.next->ghost(); ++k) prefetch(values + (*s.next)[k]);
    }

    const Cutting<Real>& cutting_;
};

#if defined(__x86_64__)
// Everything is inlined into these, and so compiled for their instruction set. (As at_level() does; but through a lambda it
// was 3 % of an extraction slower.)
template <class Real>
[[gnu::target("avx512f,avx512bw,avx512vl,bmi,bmi2"), gnu::flatten]] void
load_avx512(const Loader<Real>& loader, std::size_t place, CutScratch<Real>& s) {
    loader.load(place, s);
}
template <class Real>
[[gnu::target("avx2,bmi,bmi2"), gnu::flatten]] void load_avx2(const Loader<Real>& loader, std::size_t place,
                                                              CutScratch<Real>& s) {
    loader.load(place, s);
}
#endif

template <class Real>
void load_cluster(const Loader<Real>& loader, std::size_t place, CutScratch<Real>& s) {
    switch (level()) {
#if defined(__x86_64__)
    case Level::avx512: return load_avx512(loader, place, s);
    case Level::avx2: return load_avx2(loader, place, s);
#endif
    default: return loader.load(place, s);
    }
}

template <class Real>
class Counter {
public:
    Counter(const Cutting<Real>& cutting, Keep keep, Counted<Real>& out)
        : cutting_(cutting), loader_(cutting), keep_(keep), out_(out) {}

    void count_place(std::size_t place, CutScratch<Real>& s) const {
        if (s.cluster != cutting_.selection.clusters[place]) load_cluster(loader_, place, s);
        const Record<Real>* record = nullptr;
        if constexpr (sizeof(Real) == sizeof(float)) record = cut_plain_cluster(cutting_, place, s, out_.starts[place]);
        if (!record) {
            std::uint64_t tied = 0;
            record = cut_any_cluster(cutting_, place, s, out_.starts[place], tied);
            if (tied)
                std::atomic_ref(out_.tied_points[cutting_.selection.isovalues[place]])
                    .fetch_add(tied, std::memory_order_relaxed);
        }
        s.record_bytes += record->bytes();
        if (keep_ == Keep::records) {
            out_.records[place] = record;
        } else {
            s.unplaced = nullptr;
            s.arena.clear();
        }
    }

private:
    const Cutting<Real>& cutting_;
    const Loader<Real> loader_;
    const Keep keep_;
    Counted<Real>& out_;
};

} // namespace

template <class Real>
Result<Counted<Real>> count(const Packed& packed, const Wanted<Real>& wanted, const Selection& selection, Masks& masks,
                            Keep keep, Batches& batches, const Progress& progress) {
    Counted<Real> out;
    out.starts = core::Buffer<Start>(selection.size());
    out.records = core::Buffer<const Record<Real>*>(keep == Keep::records ? selection.size() : 0);
    out.tied_points.resize(wanted.isovalues.size());
    const Cutting<Real> cutting{packed, wanted, selection, masks};
    const Counter<Real> counter(cutting, keep, out);
    using Memory = CutScratch<Real>;
    tbb::enumerable_thread_specific<std::shared_ptr<Memory>> scratch(
        [] { return std::shared_ptr<Memory>(new Memory); });
    const auto count_batch = [&](std::size_t first, std::size_t last) {
        core::worker_ranges(last - first, 16, [&](std::size_t begin, std::size_t end) {
            if (progress.cancelled()) return;
            Memory& memory = *scratch.local();
            for (std::size_t place = first + begin; place < first + end; ++place) counter.count_place(place, memory);
            place_vertices<Portable>(memory);
        });
    };
    if (auto ok = batches.run(count_batch); !ok) return ok.error();
    out.bytes = out.starts.bytes() + out.records.bytes();
    for (std::shared_ptr<Memory>& memory : scratch) {
        out.bytes += sizeof(Memory) + memory->arena.bytes();
        out.record_bytes += memory->record_bytes;
        out.memory.push_back(std::move(memory));
    }
    return out;
}

template <class Real>
std::size_t count_scratch_bytes() {
    return sizeof(CutScratch<Real>);
}

template std::size_t count_scratch_bytes<float>();
template std::size_t count_scratch_bytes<double>();
template Result<Counted<float>> count<float>(const Packed&, const Wanted<float>&, const Selection&, Masks&, Keep,
                                             Batches&, const Progress&);
template Result<Counted<double>> count<double>(const Packed&, const Wanted<double>&, const Selection&, Masks&, Keep,
                                               Batches&, const Progress&);

std::vector<Total> scan(const Selection& selection, const Masks& masks, std::size_t isovalues,
                        core::Buffer<Start>& starts) {
    core::worker_ranges(selection.size(), 1 << 12, [&](std::size_t begin, std::size_t end) {
        at_level([&] { // which has an instruction that counts bits
            for (std::size_t place = begin; place < end; ++place) starts[place].vertex += masks.vertices(place);
        });
    });
    std::vector<Total> totals(isovalues);
    for (std::size_t place = 0; place < selection.size(); ++place) {
        Total& total = totals[selection.isovalues[place]];
        const Start own = starts[place];
        starts[place] = {total.vertices, total.triangles};
        total.vertices += own.vertex;
        total.triangles += own.triangle;
        ++total.clusters;
    }
    return totals;
}

} // namespace isotet::cpu
