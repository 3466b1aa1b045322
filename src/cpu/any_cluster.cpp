// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Any cluster: with tied points, points without data, double precision. Which of its own tied points and seam edges
// give vertices may depend on clusters that hold them too, so these are left to the masks.
#include <algorithm>
#include <cstring>
#include <type_traits>

#include "cpu/active_cells.hpp"
#include "cpu/level.hpp"
#include "cpu/simd_avx2.hpp"
#include "cpu/simd_avx512.hpp"
#include "numbers/storage.hpp"

namespace isotet::cpu {

namespace {

constexpr std::uint8_t is_tied = 1, has_no_data = 2;

template <class Real, class Simd>
class AnyCluster {
    /// What of Simd is there in single precision only.
    using Cross = std::conditional_t<std::is_same_v<Real, float>, Simd, Portable>;

public:
    AnyCluster(const Cutting<Real>& cutting, std::size_t place, CutScratch<Real>& s)
        : cutting_(cutting),
          packed_(cutting.packed),
          place_(place),
          cluster_(cutting.selection.clusters[place]),
          isovalue_number_(cutting.selection.isovalues[place]),
          isovalue_(cutting.wanted.isovalues[isovalue_number_]),
          header_(packed_.headers[cluster_]),
          links_(packed_.cluster_links(cluster_)),
          points_(std::size_t{header_.ghost_points} + header_.own_points),
          s_(s) {}

    std::uint64_t own_tied_points() const {
        const Real* const values = s_.values.data();
        return static_cast<std::uint64_t>(std::count(values + header_.ghost_points, values + points_, isovalue_.tied));
    }

    const Record<Real>* cut(Start& count) {
        classify();
        cut_cells();
        ask_further_ahead(cutting_, place_);
        s_.listed.clear();
        s_.shared.clear();
        s_.shared_keys.clear();
        if (ties_) share_tied_points();
        share_own_seams();
        share_ghost_seams();
        list_inner_edges();
        count = {s_.listed.size(), triangles_};
        return triangles_ ? write_record() : nothing();
    }

private:
    static const Record<Real>* nothing() {
        static constexpr Record<Real> record = [] {
            Record<Real> r;
            r.lists_seams = false;
            return r;
        }();
        return &record;
    }

    void classify() {
        const Real level = isovalue_.value, tied = isovalue_.tied;
        const bool merge = cutting_.wanted.ties == Ties::merge;
        std::uint8_t seen = 0;
        for (std::size_t k = 0; k < points_; ++k) {
            const Real value = s_.values[k];
            s_.above[k] = value >= level;
            s_.special[k] = static_cast<std::uint8_t>((merge && value == tied ? is_tied : 0) |
                                                      (core::is_nan(value) ? has_no_data : 0));
            seen |= s_.special[k];
        }
        ties_ = seen & is_tied;
        holes_ = seen & has_no_data;
    }

    bool is_special(unsigned corner, std::uint8_t what) const { return s_.special[corner] & what; }

    /// Takes out cells with a corner without data: few of those that are found by sides alone.
    struct TakeOutHoles {
        const AnyCluster& self;

        template <class Cells>
        void operator()(Cells& cells, std::size_t corners = 4) const {
            if (!self.holes_) return;
            std::size_t kept = 0;
            for (std::size_t i = 0; i < cells.count; ++i) {
                std::array<std::uint8_t, sizeof cells.corners[0]> v;
                std::memcpy(v.data(), &cells.corners[i], sizeof v);
                bool hole = false;
                for (std::size_t k = 0; k < corners; ++k) hole |= self.is_special(v[k], has_no_data);
                cells.corners[kept] = cells.corners[i];
                cells.cases[kept] = cells.cases[i];
                cells.places[kept] = cells.places[i];
                kept += !hole;
            }
            cells.count = kept;
        }
    };

    void cut_cells() {
        s_.cut.count = triangles_ = 0;
        const core::Range<Real> range = packed_.as<Real>().ranges[cluster_];
        if (!(range.lower < isovalue_.value)) return; // nothing below
        cut_all<Simd>(packed_, cluster_, isovalue_.value, s_, TakeOutHoles{*this});
        if (ties_) move_to_tied_points();
        for (std::size_t i = 0; i < 4 * s_.cut.count; ++i) s_.used.use(s_.keys[i]);
        for (std::size_t i = 0; i < s_.cut.count; ++i) triangles_ += s_.cut.triangles[i];
    }

    /// 1 where all three do, else 0.
    static unsigned differ(VertexKey a, VertexKey b, VertexKey c) {
        return unsigned{a != b} & unsigned{b != c} & unsigned{c != a};
    }

    /// The vertex of an edge whose end above is tied is that end. What collapses is taken out of the polygons, and they
    /// with it. Which corners are tied is as good as random: no branch.
    void move_to_tied_points() {
        std::size_t kept = 0;
        for (std::size_t i = 0; i < s_.cut.count; ++i) {
            std::array<VertexKey, 4> v;
            for (std::size_t k = 0; k < 4; ++k) {
                const VertexKey key = s_.keys[4 * i + k];
                const unsigned lower = key / KeyTable::row_size, higher = key % KeyTable::row_size;
                const unsigned above = higher + (lower - higher) * s_.above[lower];
                v[k] = is_special(above, is_tied) ? point_key(above) : key;
            }
            const unsigned first = differ(v[0], v[1], v[2]), second = differ(v[0], v[2], v[3]);
            VertexKey* const to = s_.keys.data() + 4 * kept;
            to[0] = v[0];
            to[1] = first ? v[1] : v[2];
            to[2] = first ? v[2] : v[3];
            to[3] = second ? v[3] : v[2];
            s_.cut.triangles[kept] = static_cast<std::uint8_t>(first + second);
            s_.cut.places[kept] = s_.cut.places[i];
            kept += first | second;
        }
        s_.cut.count = kept;
    }

    std::size_t place_of(std::uint32_t cluster) const { return cutting_.selection.place(cluster, isovalue_number_); }

    /// Tied points may be used by tets that their owner does not look at: every user tells it.
    void share_tied_points() {
        const auto share = [&](std::size_t local, std::size_t owner, std::uint32_t own_point) {
            if (!s_.used.has(point_key(local))) return;
            cutting_.masks.set_tied(owner, own_point);
            s_.share(point_key(local), {static_cast<std::uint32_t>(owner), SharedVertex::tied + own_point});
        };
        std::size_t local = 0;
        for (const core::Neighbour& neighbour : links_.neighbours)
            for (const std::size_t end = local + neighbour.ghost_points; local < end; ++local)
                if (s_.special[local] == is_tied) share(local, place_of(neighbour.cluster), links_.ghost_points[local]);
        for (; local < points_; ++local)
            if (s_.special[local] == is_tied)
                share(local, place_, static_cast<std::uint32_t>(local - header_.ghost_points));
    }

    /// Where all points of its owner have data, every active edge of the owner is used, and the owner knows it.
    /// Elsewhere an edge may lie between tets without data only: whoever has a valid tet there tells the owner.
    void share_own_seams() {
        std::array<VertexKey, 64 + 32> crossed; // room for what is written behind them
        for (std::size_t begin = 0; begin < links_.own_seams.size(); begin += 64) {
            const auto seams =
                links_.own_seams.subspan(begin, std::min<std::size_t>(64, links_.own_seams.size() - begin));
            std::uint64_t bits = 0, used = 0;
            Simd::cross_seams(s_.above.data(), seams, &bits, crossed.data());
            const VertexKey* key = crossed.data();
            core::for_bits(&bits, 1, [&](std::size_t k) {
                if (s_.used.has(*key)) {
                    used |= std::uint64_t{1} << k;
                    s_.share(*key, {static_cast<std::uint32_t>(place_), static_cast<std::uint32_t>(begin + k)});
                }
                ++key;
            });
            cutting_.masks.set_seams(place_, begin / 64, used);
        }
    }

    void share_ghost_seams() {
        const std::size_t crossed =
            Simd::cross_seams(s_.above.data(), links_.ghost_seams, s_.crossed.data(), s_.ghost_keys.data());
        const SharedVertex* const owned = s_.shared.end(); // and what is shared is moved down to there
        Simd::find_owners(links_, s_.crossed.data(), cutting_.selection.base.data(), isovalue_number_, s_.shared.end());
        for (std::size_t i = 0; i < crossed; ++i) {
            if (!s_.used.has(s_.ghost_keys[i])) continue; // an end without data, whose owner may have no place
            const SharedVertex vertex = owned[i];
            if (packed_.has_no_data[cutting_.selection.clusters[vertex.owner]])
                cutting_.masks.set_seam(vertex.owner, vertex.index);
            s_.share(s_.ghost_keys[i], vertex);
        }
    }

    void list_inner_edges() { s_.listed.grow(Simd::list_keys(s_.used, s_.listed.end())); }

    const Record<Real>* write_record() {
        Record<Real>& record = begin_record(cutting_.wanted, triangles_, s_);
        record.lists_seams = false;
        place_vertices<Cross>(s_);
        Cross::cross(s_.listed.data(), record.listed, s_.above.data(), s_.values.data(), isovalue_, s_.ends.data(),
                     s_.weights.data());
        keep_vertices(packed_, s_, record);
        with_numbers(s_, record, [&](const auto* numbers, auto* corners) {
            write_triangles(s_, numbers, corners, record.has_tets ? record.tets() : nullptr);
        });
        return &record;
    }

    const Cutting<Real>& cutting_;
    const Packed& packed_;
    const std::size_t place_, cluster_;
    const std::uint32_t isovalue_number_;
    const core::StoredIsovalue<Real> isovalue_;
    const core::ClusterHeader& header_;
    const core::ClusterLinks links_;
    const std::size_t points_;
    CutScratch<Real>& s_;
    std::size_t triangles_ = 0;
    bool ties_ = false, holes_ = false; ///< some points are tied, without data
};

template <class Simd, class Real>
const Record<Real>* cut_any(const Cutting<Real>& cutting, std::size_t place, CutScratch<Real>& scratch, Start& count,
                            std::uint64_t& tied_points) {
    AnyCluster<Real, Simd> cluster(cutting, place, scratch);
    tied_points += cluster.own_tied_points();
    return cluster.cut(count);
}

#if defined(__x86_64__)
// Everything is inlined into these, and so compiled for their instruction set.
template <class Real>
[[gnu::target("avx512f,avx512bw,avx512vl,avx512vbmi,avx512vbmi2,bmi,bmi2,popcnt"), gnu::flatten]] const Record<Real>*
cut_any_avx512(const Cutting<Real>& cutting, std::size_t place, CutScratch<Real>& s, Start& count,
               std::uint64_t& tied_points) {
    return cut_any<Avx512>(cutting, place, s, count, tied_points);
}
template <class Real>
[[gnu::target("avx2,bmi,bmi2,popcnt"), gnu::flatten]] const Record<Real>*
cut_any_avx2(const Cutting<Real>& cutting, std::size_t place, CutScratch<Real>& s, Start& count,
             std::uint64_t& tied_points) {
    return cut_any<Avx2>(cutting, place, s, count, tied_points);
}
#endif

} // namespace

template <class Real>
const Record<Real>* cut_any_cluster(const Cutting<Real>& cutting, std::size_t place, CutScratch<Real>& scratch,
                                    Start& count, std::uint64_t& tied_points) {
    switch (level()) {
#if defined(__x86_64__)
    case Level::avx512: return cut_any_avx512(cutting, place, scratch, count, tied_points);
    case Level::avx2: return cut_any_avx2(cutting, place, scratch, count, tied_points);
#endif
    default: return cut_any<Portable>(cutting, place, scratch, count, tied_points);
    }
}

template const Record<float>* cut_any_cluster<float>(const Cutting<float>&, std::size_t, CutScratch<float>&, Start&,
                                                     std::uint64_t&);
template const Record<double>* cut_any_cluster<double>(const Cutting<double>&, std::size_t, CutScratch<double>&, Start&,
                                                       std::uint64_t&);

} // namespace isotet::cpu
