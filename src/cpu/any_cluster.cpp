// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Any cluster: with tied points, points without data, double precision. Which of its own tied points and seam edges
// give vertices may depend on clusters that hold them too, so these are left to the masks.
#include <algorithm>
#include <bit>

#include "core/storage.hpp"
#include "cpu/cutting.hpp"

namespace isotet::cpu {

namespace {

constexpr std::uint8_t is_tied = 1, has_no_data = 2;

template <class Real>
class AnyCluster {
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
        cut_tets();
        s_.listed.clear();
        s_.shared.clear();
        s_.shared_keys.clear();
        if (cutting_.wanted.ties == Ties::merge) share_tied_points();
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
        const bool merge = cutting_.wanted.ties == Ties::merge;
        for (std::size_t k = 0; k < points_; ++k) {
            const Real value = s_.values[k];
            s_.above[k] = value >= isovalue_.value;
            s_.special[k] = static_cast<std::uint8_t>(merge && value == isovalue_.tied ? is_tied
                                                      : core::is_nan(value)            ? has_no_data
                                                                                       : 0);
        }
    }

    void cut_tets() {
        s_.cut.count = 0;
        const core::Range<Real> range = packed_.as<Real>().ranges[cluster_];
        if (!(range.lower < isovalue_.value)) return; // nothing below
        const auto tets = packed_.cluster_tets(cluster_);
        const core::GroupRange* const groups = packed_.group_ranges.data() + header_.first_group;
        const std::uint8_t step = core::quantize(isovalue_.value, range);
        const auto is_hit = [&](std::size_t group) {
            return groups[group].lower <= step && step <= groups[group].upper;
        };
        for (std::size_t begin = 0; begin < tets.size(); begin += core::group_size) {
            if (!is_hit(begin / core::group_size)) continue;
            for (std::size_t i = begin; i < std::min(begin + core::group_size, tets.size()); ++i)
                cut_tet(i, tets[i].corners);
        }
        if (header_.others())
            packed_.for_other_cells(cluster_, [&](const core::StoredCell& cell) {
                if (is_hit(cell.word / core::group_size)) cut_cell(cell);
            });
    }

    void cut_tet(std::size_t tet, const std::array<std::uint8_t, 4>& v) {
        unsigned index = 0, tied = 0;
        for (std::size_t k = 0; k < 4; ++k) {
            if (s_.special[v[k]] == has_no_data) return;
            index |= unsigned{s_.above[v[k]]} << k;
            tied |= unsigned{s_.special[v[k]]} << k;
        }
        // With corners below, above, and tied: something below, and something above or three tied.
        if (index == 0 || index == 15 || (index == tied && std::popcount(tied) < 3)) return;
        const core::TetCase& c = core::case_table[index];
        VertexKey* const keys = s_.keys.data() + 4 * s_.cut.count;
        for (std::size_t k = 0; k < 4; ++k) keys[k] = key_of(v[c.polygon[k].above], v[c.polygon[k].below]);
        for (std::size_t k = 0; k < 4; ++k) s_.used.use(keys[k]);
        add_polygon(keys, c.triangles, tet);
    }

    void cut_cell(const core::StoredCell& cell) {
        unsigned index = 0;
        for (std::size_t k = 0; k < cell.corners.size(); ++k) {
            if (s_.special[cell.corners[k]] == has_no_data) return;
            index |= unsigned{s_.above[cell.corners[k]]} << k;
        }
        for (const core::CellPolygon& polygon : core::polygons_of(cell.kind, index)) {
            VertexKey* const keys = s_.keys.data() + 4 * s_.cut.count;
            for (std::size_t k = 0; k < 4; ++k)
                keys[k] = key_of(cell.corners[polygon.edges[k].above], cell.corners[polygon.edges[k].below]);
            for_triangles(keys, polygon.triangles, [&](std::size_t t) {
                for (const std::uint8_t k : core::triangle_corners[t]) s_.used.use(keys[k]);
            });
            add_polygon(keys, polygon.triangles, cell.word);
        }
    }

    VertexKey key_of(std::uint8_t above, std::uint8_t below) const {
        return s_.special[above] == is_tied ? point_key(above)
                                            : edge_key({std::min(above, below), std::max(above, below)});
    }

    void add_polygon(const VertexKey* keys, std::size_t triangles, std::size_t word) {
        for_triangles(keys, triangles, [&](std::size_t) { ++triangles_; });
        s_.cut.triangles[s_.cut.count] = static_cast<std::uint8_t>(triangles);
        s_.cut.places[s_.cut.count++] = static_cast<std::uint16_t>(word);
    }

    /// Calls f(0) and f(1) for the triangles of a polygon whose corners are three different vertices.
    template <class F>
    static void for_triangles(const VertexKey* keys, std::size_t triangles, F&& f) {
        for (std::size_t t = 0; t < triangles; ++t) {
            const auto& corner = core::triangle_corners[t];
            const VertexKey a = keys[corner[0]], b = keys[corner[1]], d = keys[corner[2]];
            if (a != b && b != d && d != a) f(t);
        }
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
        for (std::size_t k = 0; k < links_.own_seams.size(); ++k) {
            const VertexKey key = edge_key(links_.own_seams[k]);
            if (!s_.used.has(key)) continue;
            cutting_.masks.set_seam(place_, k);
            s_.share(key, {static_cast<std::uint32_t>(place_), static_cast<std::uint32_t>(k)});
        }
    }

    void share_ghost_seams() {
        std::size_t k = 0;
        for (const core::Neighbour& neighbour : links_.neighbours) {
            for (const std::size_t end = k + neighbour.ghost_seams; k < end; ++k) {
                const core::GhostSeam seam = links_.ghost_seams[k];
                if (!s_.used.has(edge_key(seam.edge))) continue;
                const std::size_t owner = place_of(neighbour.cluster);
                if (packed_.has_no_data[neighbour.cluster]) cutting_.masks.set_seam(owner, seam.index);
                s_.share(edge_key(seam.edge), {static_cast<std::uint32_t>(owner), seam.index});
            }
        }
    }

    void list_inner_edges() { s_.listed.grow(Portable::list_keys(s_.used, s_.listed.end())); }

    const Record<Real>* write_record() {
        Record<Real>& record = begin_record(cutting_.wanted, triangles_, s_);
        record.lists_seams = false;
        Portable::cross(s_.listed.data(), record.listed, s_.above.data(), s_.values.data(), isovalue_, s_.ends.data(),
                        s_.weights.data());
        ask_for_positions(packed_, s_, record);
        with_numbers(s_, record, [&](const auto* numbers, auto* corners) {
            write_triangles(numbers, corners, record.has_tets ? record.tets() : nullptr);
        });
        write_vertices<Portable>(packed_, s_, record);
        return &record;
    }

    template <class Number>
    void write_triangles(const Number* numbers, Number* corner, std::uint16_t* tet) const {
        for (std::size_t i = 0; i < s_.cut.count; ++i) {
            const VertexKey* const keys = s_.keys.data() + 4 * i;
            for_triangles(keys, s_.cut.triangles[i], [&](std::size_t t) {
                for (const std::uint8_t k : core::triangle_corners[t]) *corner++ = numbers[keys[k]];
                if (tet) *tet++ = s_.cut.places[i];
            });
        }
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
};

} // namespace

template <class Real>
const Record<Real>* cut_any_cluster(const Cutting<Real>& cutting, std::size_t place, CutScratch<Real>& scratch,
                                    Start& count, std::uint64_t& tied_points) {
    AnyCluster<Real> cluster(cutting, place, scratch);
    tied_points += cluster.own_tied_points();
    return cluster.cut(count);
}

template const Record<float>* cut_any_cluster<float>(const Cutting<float>&, std::size_t, CutScratch<float>&, Start&,
                                                     std::uint64_t&);
template const Record<double>* cut_any_cluster<double>(const Cutting<double>&, std::size_t, CutScratch<double>&, Start&,
                                                       std::uint64_t&);

} // namespace isotet::cpu
