// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <memory>

#include <tbb/enumerable_thread_specific.h>

#include "core/arithmetic.hpp"
#include "core/parallel.hpp"
#include "cpu/cut_cluster.hpp"
#include "cpu/steps.hpp"

namespace isotet::cpu {

namespace {

/// One thread's memory: the cut cluster, and the number of the vertex on each of its crossed edges. That table is never
/// cleared: only entries that were written for this cluster are read.
template <class Real, class Index>
struct Scratch {
    CutCluster<Real> cut;
    std::array<Real, 3 * max_cluster_points> positions;
    std::array<std::uint64_t, max_cluster_points> packed_points;
    std::array<Index, max_cluster_points> tied_numbers;
    std::array<Index, max_cluster_points * max_cluster_points> edge_numbers; ///< [lower][higher]
};

template <class Real, class Index>
class Emitter {
public:
    Emitter(const Packed& packed, const Request<Real>& request, const Selection& selection, const Masks& masks,
            const Counted& counted, const core::Buffer<Start>& starts, const Target<Real>& target, Index* triangles)
        : packed_(packed), request_(request), selection_(selection), masks_(masks), counted_(counted), starts_(starts),
          target_(target), triangles_(triangles) {}

    void emit_cluster(std::size_t place, Scratch<Real, Index>& s) const {
        const Start start = starts_[place];
        const bool has_vertices = starts_[place + 1].vertex != start.vertex;
        if (!has_vertices && starts_[place + 1].triangle == start.triangle) return;
        const std::size_t cluster = selection_.clusters[place];
        if constexpr (sizeof(Real) == sizeof(float))
            if (const Record* record = counted_.records[place]) return copy_record(cluster, *record, start, s);
        s.cut.cut(packed_, cluster, request_.isovalues.front(), request_.ties);
        if (has_vertices) {
            core::load_positions(packed_, cluster, s.positions.data());
            if (target_.ends || target_.normals) core::local_points(packed_, cluster, s.packed_points.data());
        }
        number_foreign(cluster, s);
        emit_vertices(cluster, place, s);
        emit_triangles(cluster, start.triangle, s);
    }

private:
    /// The number of the vertex on a seam edge, given its owner.
    Index seam_number(std::size_t owner, std::size_t seam) const {
        return static_cast<Index>(starts_[owner].vertex + core::count_bits(masks_.tied(owner), Masks::tied_words) +
                                  core::rank_of_bit(masks_.seams(owner), seam));
    }

    /// A plain cluster: everything but the numbers is in the record.
    void copy_record(std::size_t cluster, const Record& record, Start start, Scratch<Real, Index>& s) const {
        std::copy_n(record.positions(), 3 * std::size_t{record.own}, target_.positions + 3 * start.vertex);
        Index* const numbers = s.edge_numbers.data(); // local number -> number; there are fewer than entries
        for (std::size_t i = 0; i < record.own; ++i) numbers[i] = static_cast<Index>(start.vertex + i);
        const ForeignVertex* foreign = record.foreign_vertices();
        for (std::size_t i = 0; i < record.foreign; ++i) numbers[record.own + i] = seam_number(foreign[i].owner, foreign[i].seam);
        const std::uint16_t* corners = record.corners();
        Index* const out = triangles_ + 3 * start.triangle;
        for (std::size_t i = 0; i < 3 * std::size_t{record.triangles}; ++i) out[i] = numbers[corners[i]];

        if (record.ends_at) {
            core::local_points(packed_, cluster, s.packed_points.data());
            for (std::size_t i = 0; i < record.own; ++i)
                emit_ends(s, start.vertex + i, record.ends()[i].below, record.ends()[i].above, record.weights()[i]);
        }
        if (record.tets_at)
            for (std::size_t t = 0; t < record.triangles; ++t) emit_source(cluster, start.triangle + t, record.tets()[t]);
    }

    /// Numbers of vertices that other clusters emit; their edges leave the matrix.
    void number_foreign(std::size_t cluster, Scratch<Real, Index>& s) const {
        const core::ClusterLinks links = packed_.cluster_links(cluster);
        const bool has_tied = s.cut.has_tied();
        std::size_t local = 0, seam = 0;
        for (const core::Neighbour& neighbour : links.neighbours) {
            const std::size_t points_end = local + neighbour.foreign_points, seams_end = seam + neighbour.foreign_seams;
            for (; has_tied && local < points_end; ++local) {
                if (!core::test_bit(s.cut.used_tied.data(), local)) continue;
                const std::size_t owner = selection_.place[neighbour.cluster];
                s.tied_numbers[local] = static_cast<Index>(starts_[owner].vertex +
                                                           core::rank_of_bit(masks_.tied(owner), links.foreign_points[local]));
            }
            for (; seam < seams_end; ++seam) {
                const core::ForeignSeam& foreign = links.foreign_seams[seam];
                if (!s.cut.edges.test(foreign.edge)) continue;
                s.cut.edges.remove(foreign.edge);
                const std::size_t owner = selection_.place[neighbour.cluster];
                number(s, foreign.edge) = seam_number(owner, foreign.index);
            }
        }
    }

    void emit_vertices(std::size_t cluster, std::size_t place, Scratch<Real, Index>& s) const {
        const core::ClusterHeader& h = packed_.headers[cluster];
        std::uint64_t next = starts_[place].vertex;
        core::for_bits(masks_.tied(place), Masks::tied_words, [&](std::size_t own) {
            const std::size_t local = h.foreign_points + own;
            s.tied_numbers[local] = static_cast<Index>(next);
            emit_vertex(s, next++, local, local, Real(0));
        });
        const auto own_seams = packed_.cluster_links(cluster).own_seams;
        core::for_bits(masks_.seams(place), masks_.seam_words(place), [&](std::size_t k) {
            const core::SeamEdge edge = own_seams[k];
            s.cut.edges.remove(edge);
            number(s, edge) = static_cast<Index>(next);
            emit_on_edge(s, next++, edge.lower, edge.higher);
        });
        s.cut.edges.for_edges([&](std::size_t lower, std::size_t higher) {
            s.edge_numbers[lower * max_cluster_points + higher] = static_cast<Index>(next);
            emit_on_edge(s, next++, lower, higher);
        });
    }

    void emit_on_edge(const Scratch<Real, Index>& s, std::uint64_t vertex, std::size_t a, std::size_t b) const {
        if (s.cut.is_above(a)) std::swap(a, b);
        emit_vertex(s, vertex, a, b, core::edge_weight(request_.isovalues.front(), s.cut.values[a], s.cut.values[b]));
    }

    void emit_vertex(const Scratch<Real, Index>& s, std::uint64_t vertex, std::size_t below, std::size_t above, Real t) const {
        for (std::size_t axis = 0; axis < 3; ++axis)
            target_.positions[3 * vertex + axis] =
                core::interpolate(s.positions[3 * below + axis], s.positions[3 * above + axis], t);
        emit_ends(s, vertex, below, above, t);
    }

    /// What else depends on the ends of a vertex.
    void emit_ends(const Scratch<Real, Index>& s, std::uint64_t vertex, std::size_t below, std::size_t above, Real t) const {
        if (target_.ends) {
            target_.ends[2 * vertex] = static_cast<std::int64_t>(packed_.user_point(s.packed_points[below]));
            target_.ends[2 * vertex + 1] = static_cast<std::int64_t>(packed_.user_point(s.packed_points[above]));
            target_.weights[vertex] = t;
        }
        if (target_.normals) {
            const auto normal = core::vertex_normal(packed_.gradients[s.packed_points[below]],
                                                    packed_.gradients[s.packed_points[above]], t);
            for (std::size_t axis = 0; axis < 3; ++axis) target_.normals[3 * vertex + axis] = static_cast<float>(normal[axis]);
        }
    }

    void emit_source(std::size_t cluster, std::uint64_t triangle, std::size_t tet) const {
        const std::uint64_t first_stored = core::group_size * std::uint64_t{packed_.headers[cluster].first_group};
        target_.source_cells[triangle] = static_cast<std::int64_t>(packed_.user_cell(first_stored + tet));
    }

    void emit_triangles(std::size_t cluster, std::uint64_t next, Scratch<Real, Index>& s) const {
        const auto tets = packed_.cluster_tets(cluster);
        const bool has_tied = s.cut.has_tied();
        for (std::size_t i = 0; i < s.cut.cut_count; ++i) {
            const auto [tet, index] = s.cut.cut_tet[i];
            const auto& v = tets[tet].corners;
            const core::TetCase& c = core::case_table[index];
            Index polygon[4];
            for (std::size_t k = 0; k < 4; ++k) {
                const std::uint8_t above = v[c.polygon[k].above], below = v[c.polygon[k].below];
                polygon[k] = has_tied && s.cut.is_tied(above)
                                 ? s.tied_numbers[above]
                                 : number(s, {std::min(above, below), std::max(above, below)});
            }
            for (std::size_t t = 0; t < c.triangles; ++t) {
                const auto& corners = core::triangle_corners[t];
                const Index a = polygon[corners[0]], b = polygon[corners[1]], d = polygon[corners[2]];
                if (has_tied && (a == b || b == d || d == a)) continue;
                triangles_[3 * next] = a;
                triangles_[3 * next + 1] = b;
                triangles_[3 * next + 2] = d;
                if (target_.source_cells) emit_source(cluster, next, tet);
                ++next;
            }
        }
    }

    static Index& number(Scratch<Real, Index>& s, core::SeamEdge edge) {
        return s.edge_numbers[std::size_t{edge.lower} * max_cluster_points + edge.higher];
    }

    const Packed& packed_;
    const Request<Real>& request_;
    const Selection& selection_;
    const Masks& masks_;
    const Counted& counted_;
    const core::Buffer<Start>& starts_;
    const Target<Real>& target_;
    Index* triangles_;
};

} // namespace

template <class Real, class Index>
void emit(const Packed& packed, const Request<Real>& request, const Selection& selection, const Masks& masks,
          const Counted& counted, const core::Buffer<Start>& starts, const Target<Real>& target, Index* triangles,
          const Progress& progress) {
    const Emitter<Real, Index> emitter(packed, request, selection, masks, counted, starts, target, triangles);
    using Memory = Scratch<Real, Index>;
    tbb::enumerable_thread_specific<std::unique_ptr<Memory>> scratch([] { return std::make_unique_for_overwrite<Memory>(); });
    core::parallel_ranges(selection.clusters.size(), 16, [&](std::size_t begin, std::size_t end) {
        if (progress.cancelled()) return;
        Memory& memory = *scratch.local();
        for (std::size_t place = begin; place < end; ++place) emitter.emit_cluster(place, memory);
    });
}

#define ISOTET_EMIT(Real, Index)                                                                                          \
    template void emit<Real, Index>(const Packed&, const Request<Real>&, const Selection&, const Masks&,                  \
                                    const Counted&, const core::Buffer<Start>&, const Target<Real>&, Index*, const Progress&)
ISOTET_EMIT(float, std::uint32_t);
ISOTET_EMIT(float, std::uint64_t);
ISOTET_EMIT(double, std::uint32_t);
ISOTET_EMIT(double, std::uint64_t);
#undef ISOTET_EMIT

} // namespace isotet::cpu
