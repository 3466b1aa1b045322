// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <limits>
#include <memory>
#include <utility>

#include <tbb/enumerable_thread_specific.h>

#include "base/workers.hpp"
#include "cpu/batches.hpp"
#include "cpu/field_writer.hpp"
#include "cpu/level.hpp"
#include "cpu/prefetch.hpp"
#include "cpu/simd_avx2.hpp"
#include "cpu/simd_avx512.hpp"
#include "cpu/simd_portable.hpp"
#include "cpu/steps.hpp"
#include "cpu/vertex_normals.hpp"
#include "numbers/arithmetic.hpp"
#include "packed/local_values.hpp"

namespace isotet::cpu {

namespace {

/// The local points of a cluster, found once.
struct FoundPoints {
    std::size_t cluster = std::numeric_limits<std::size_t>::max();
    core::LocalPoints packed;

    void find(const Packed& grid, std::size_t of) {
        if (cluster == of) return;
        packed.find(grid, of);
        cluster = of;
    }
};

/// Own vertices of a cluster, in order: their edges, and where on them they lie.
template <class Real>
struct OwnVertices {
    const EndPair* ends;
    const Real* weights;
    std::size_t count;
};

/// One thread's memory.
template <class Real>
struct Scratch {
    std::array<FoundPoints, 2> found;
    FoundPoints* points = &found[0];        ///< of the cluster at hand, where its ends are looked at
    FoundPoints* next = &found[1];          ///< of the one after it
    std::array<EndPair, max_vertices> ends; ///< of vertices that only masks know
    std::array<Real, max_vertices> weights;
    std::array<std::uint32_t, max_vertices + 32> numbers{}; ///< of vertices, by local number; SIMD code reads more
    std::array<std::uint64_t, max_vertices> wide_numbers;
    bool seams_differ = false; ///< a triangle has a vertex that is not there
};

template <class Real>
class Emitter {
public:
    Emitter(const Packed& packed, const Wanted<Real>& wanted, const Selection& selection, const Masks& masks,
            const Counted<Real>& counted, std::span<const Target<Real>> targets)
        : packed_(packed),
          reals_(packed.as<Real>()),
          wanted_(wanted),
          selection_(selection),
          masks_(masks),
          counted_(counted),
          targets_(targets) {}

    template <class Simd>
    void emit_places(std::size_t begin, std::size_t end, Scratch<Real>& s) const {
        for (std::size_t place = begin; place < end; ++place) {
            if (needs_points(*counted_.records[place])) find_points(selection_.clusters[place], s);
            ask_ahead(place, s);
            emit_place<Simd>(place, s);
        }
    }

    /// Whether more than the record of a place is looked at.
    bool needs_cluster(std::size_t place) const {
        const Record<Real>& record = *counted_.records[place];
        return needs_points(record) || record.has_tets;
    }

private:
    /// Whether ends of edges are looked at, as local points.
    static bool needs_points(const Record<Real>& record) { return record.has_ends || !record.lists_seams; }

    void find_points(std::uint32_t cluster, Scratch<Real>& s) const {
        if (s.points->cluster == cluster) return;
        std::swap(s.points, s.next);
        s.points->find(packed_, cluster);
    }

    /// Asks for what the places to come will read, while this one is worked on.
    void ask_ahead(std::size_t place, Scratch<Real>& s) const {
        const std::size_t left = selection_.ahead_end - place;
        if (left > 3) {
            prefetch(&packed_.headers[selection_.clusters[place + 3]]);
            prefetch(counted_.records[place + 3]);
        }
        if (left > 2) {
            const Record<Real>& record = *counted_.records[place + 2];
            prefetch_bytes(&record, record.bytes());
            if (needs_points(record)) ask_for_links(selection_.clusters[place + 2]);
        }
        if (left > 1) ask_for_positions(place + 1, s);
    }

    void ask_for_links(std::uint32_t cluster) const {
        const core::ClusterHeader& h = packed_.headers[cluster];
        prefetch_bytes(packed_.links.data() + h.first_link, 4 * core::ClusterLinks::words(h));
    }

    void ask_for_positions(std::size_t place, Scratch<Real>& s) const {
        const Record<Real>& record = *counted_.records[place];
        if (!needs_points(record)) return;
        const std::uint32_t cluster = selection_.clusters[place];
        FoundPoints& found = s.points->cluster == cluster ? *s.points : *s.next;
        found.find(packed_, cluster);
        for (std::size_t i = 0; record.has_ends && i < record.listed; ++i) {
            prefetch(&reals_.positions[3 * found.packed[record.ends()[i].below]]);
            prefetch(&reals_.positions[3 * found.packed[record.ends()[i].above]]);
        }
    }

    template <class Simd>
    void emit_place(std::size_t place, Scratch<Real>& s) const {
        const Record<Real>& record = *counted_.records[place];
        const Target<Real>& target = targets_[selection_.isovalues[place]];
        const Start start = counted_.starts[place];
        std::uint64_t vertex = start.vertex;
        if (!record.lists_seams) {
            const OwnVertices<Real> masked = find_masked(place, s);
            write_vertices(masked, vertex, target, s);
            vertex += masked.count;
        }
        if (record.has_ends) write_vertices({record.ends(), record.weights(), record.listed}, vertex, target, s);
        else Simd::copy(record.positions(), 3u * record.listed, target.positions + 3 * vertex);

        const bool all_there = target.triangles
                                   ? write_triangles<Simd>(record, vertex, target.vertices, s.numbers.data(),
                                                           target.triangles + 3 * start.triangle)
                                   : write_triangles<Simd>(record, vertex, target.vertices, s.wide_numbers.data(),
                                                           target.wide_triangles + 3 * start.triangle);
        s.seams_differ |= !all_there;
        if (record.has_tets) write_sources(record, selection_.clusters[place], target.source_cells + start.triangle);
    }

    /// Vertices of a cluster that is not plain: at tied points and on seam edges. Others may be who uses them.
    OwnVertices<Real> find_masked(std::size_t place, Scratch<Real>& s) const {
        const core::ClusterHeader& h = packed_.headers[s.points->cluster];
        const core::StoredIsovalue<Real>& isovalue = wanted_.isovalues[selection_.isovalues[place]];
        std::size_t count = 0;
        core::for_bits(masks_.tied(place), Masks::tied_words, [&](std::size_t own) {
            const auto local = static_cast<std::uint8_t>(h.ghost_points + own);
            s.ends[count] = {local, local};
            s.weights[count++] = 0;
        });
        const auto own_seams = packed_.cluster_links(s.points->cluster).own_seams;
        core::for_bits(masks_.seams(place), masks_.seam_words(place), [&](std::size_t k) {
            std::uint8_t below = own_seams[k].lower, above = own_seams[k].higher;
            const auto value = [&](std::uint8_t local) { return reals_.values[s.points->packed[local]]; };
            if (value(below) >= isovalue.value) std::swap(below, above);
            s.ends[count] = {below, above};
            s.weights[count++] = core::edge_weight(isovalue, value(below), value(above));
        });
        return {s.ends.data(), s.weights.data(), count};
    }

    void write_vertices(const OwnVertices<Real>& own, std::uint64_t first, const Target<Real>& target,
                        const Scratch<Real>& s) const {
        const auto& points = s.points->packed;
        Real* position = target.positions + 3 * first;
        for (std::size_t i = 0; i < own.count; ++i, position += 3) {
            const Real* const a = reals_.positions.data() + 3 * points[own.ends[i].below];
            const Real* const b = reals_.positions.data() + 3 * points[own.ends[i].above];
            for (std::size_t axis = 0; axis < 3; ++axis)
                position[axis] = core::interpolate(a[axis], b[axis], own.weights[i]);
        }
        if (target.ends || !target.fields.empty()) write_ends(own, first, target, s);
        if (target.normals) write_normals(own, target.normals + 3 * first, s);
    }

    /// The user's points, and what depends on them.
    void write_ends(const OwnVertices<Real>& own, std::uint64_t first, const Target<Real>& target,
                    const Scratch<Real>& s) const {
        constexpr std::size_t at_once = 64;
        std::array<std::uint64_t, at_once> below, above, packed_below, packed_above;
        for (std::size_t begin = 0; begin < own.count; begin += at_once, first += at_once) {
            const std::size_t count = std::min(own.count - begin, at_once);
            const Real* const weights = own.weights + begin;
            for (std::size_t i = 0; i < count; ++i) {
                packed_below[i] = s.points->packed[own.ends[begin + i].below];
                packed_above[i] = s.points->packed[own.ends[begin + i].above];
                below[i] = packed_.user_point(packed_below[i]);
                above[i] = packed_.user_point(packed_above[i]);
            }
            if (target.ends) {
                for (std::size_t i = 0; i < count; ++i) {
                    target.ends[2 * (first + i)] = static_cast<std::int64_t>(below[i]);
                    target.ends[2 * (first + i) + 1] = static_cast<std::int64_t>(above[i]);
                }
                std::copy_n(weights, count, target.weights + first);
            }
            for (std::size_t f = 0; f < target.fields.size(); ++f) {
                const ops::CarriedField& field = wanted_.fields[f];
                write_field<Real>(field,
                                  {(field.packed ? packed_below : below).data(),
                                   (field.packed ? packed_above : above).data(), weights, count},
                                  target.fields[f] + first * field.values.components());
            }
        }
    }

    void write_normals(const OwnVertices<Real>& own, float* out, const Scratch<Real>& s) const {
        using Normals = VertexNormals<Real>;
        for (std::size_t begin = 0; begin < own.count; begin += Normals::lanes) {
            const std::size_t count = std::min(own.count - begin, Normals::lanes);
            typename Normals::Codes below{}, above{};
            typename Normals::Lanes weights{};
            for (std::size_t i = 0; i < count; ++i) {
                below[i] = packed_.gradients[s.points->packed[own.ends[begin + i].below]];
                above[i] = packed_.gradients[s.points->packed[own.ends[begin + i].above]];
                weights[i] = own.weights[begin + i];
            }
            Normals normals;
            normals.compute(below, above, weights);
            for (std::size_t i = 0; i < count; ++i)
                for (std::size_t axis = 0; axis < 3; ++axis) *out++ = static_cast<float>(normals.normal[axis][i]);
        }
    }

    /// `numbers`  room for those of shared vertices
    /// Returns whether all vertices are there.
    template <class Simd, class Index>
    bool write_triangles(const Record<Real>& record, std::uint64_t first_vertex, std::uint64_t vertices, Index* numbers,
                         Index* out) const {
        const SharedVertex* const shared = record.shared_vertices();
        bool all_there = true;
        for (std::size_t i = 0; i < record.shared; ++i) {
            const std::uint64_t vertex = counted_.starts[shared[i].owner].vertex + masks_.rank(shared[i]);
            all_there &= vertex < vertices;
            numbers[record.listed + i] = static_cast<Index>(vertex);
        }
        const auto number = [&]<class Local>(const Local* local) {
            Simd::number(local, 3u * record.triangles, record.listed, first_vertex, numbers, out);
        };
        if (record.wide()) number(static_cast<const std::uint16_t*>(record.corners()));
        else number(static_cast<const std::uint8_t*>(record.corners()));
        return all_there;
    }

    void write_sources(const Record<Real>& record, std::size_t cluster, std::int64_t* out) const {
        const std::uint64_t first_word = packed_.headers[cluster].first_word;
        for (std::size_t t = 0; t < record.triangles; ++t)
            out[t] = static_cast<std::int64_t>(packed_.user_cell(first_word + record.tets()[t]));
    }

    const Packed& packed_;
    const core::Values<Real>& reals_;
    const Wanted<Real>& wanted_;
    const Selection& selection_;
    const Masks& masks_;
    const Counted<Real>& counted_;
    const std::span<const Target<Real>> targets_;
};

#if defined(__x86_64__)
// Everything is inlined into these, and so compiled for their instruction set.
template <class Real>
[[gnu::target("avx512f,avx512bw,avx512vl,avx512vbmi,avx512vbmi2,bmi,bmi2,popcnt"), gnu::flatten]] void
emit_avx512(const Emitter<Real>& emitter, std::size_t begin, std::size_t end, Scratch<Real>& s) {
    emitter.template emit_places<Avx512>(begin, end, s);
}
template <class Real>
[[gnu::target("avx2,bmi,bmi2,popcnt"), gnu::flatten]] void emit_avx2(const Emitter<Real>& emitter, std::size_t begin,
                                                                     std::size_t end, Scratch<Real>& s) {
    emitter.template emit_places<Avx2>(begin, end, s);
}
#endif

template <class Real>
void emit_places(const Emitter<Real>& emitter, std::size_t begin, std::size_t end, Scratch<Real>& s) {
    switch (level()) {
#if defined(__x86_64__)
    case Level::avx512: return emit_avx512(emitter, begin, end, s);
    case Level::avx2: return emit_avx2(emitter, begin, end, s);
#endif
    default: return emitter.template emit_places<Portable>(begin, end, s);
    }
}

} // namespace

template <class Real>
Result<void> emit(const Packed& packed, const Wanted<Real>& wanted, const Selection& selection, const Masks& masks,
                  const Counted<Real>& counted, std::span<const Target<Real>> targets, Batches& batches,
                  const Progress& progress) {
    const Emitter<Real> emitter(packed, wanted, selection, masks, counted, targets);
    tbb::enumerable_thread_specific<std::unique_ptr<Scratch<Real>>> scratch(
        [] { return std::unique_ptr<Scratch<Real>>(new Scratch<Real>); });
    const auto emit_batch = [&](std::size_t first, std::size_t last) {
        core::worker_ranges(last - first, 64, [&](std::size_t begin, std::size_t end) {
            if (progress.cancelled()) return;
            emit_places(emitter, first + begin, first + end, *scratch.local());
        });
    };
    if (auto ok = batches.run(emit_batch, [&](std::size_t place) { return emitter.needs_cluster(place); }); !ok)
        return ok;
    if (std::ranges::any_of(scratch, [](const auto& one) { return one->seams_differ; }))
        return Error{
            ErrorCode::invalid_data, // of a grid from a file
            "a triangle has a vertex that is not there: the seam edges of two clusters differ, but must be the same"};
    return {};
}

template <class Real>
std::size_t emit_scratch_bytes() {
    return sizeof(Scratch<Real>);
}

template std::size_t emit_scratch_bytes<float>();
template std::size_t emit_scratch_bytes<double>();

template Result<void> emit<float>(const Packed&, const Wanted<float>&, const Selection&, const Masks&,
                                  const Counted<float>&, std::span<const Target<float>>, Batches&, const Progress&);
template Result<void> emit<double>(const Packed&, const Wanted<double>&, const Selection&, const Masks&,
                                   const Counted<double>&, std::span<const Target<double>>, Batches&,
                                   const Progress&);

} // namespace isotet::cpu
