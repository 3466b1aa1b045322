// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Directions of the gradient at points: the sum over the valid tets of each point, in stored order, of the tet's
// gradient times its volume, in double; of a piece with a frame, in the order of the terms' values.
#include <vector>

#include "packed/local_values.hpp"
#include "numbers/normal_code.hpp"
#include "grid/orientation.hpp"
#include "packed/set_field.hpp"
#include "base/workers.hpp"
#include "numbers/storage.hpp"
#include "packed/stored_cells.hpp"
#include "numbers/sum_of_terms.hpp"
#include "numbers/tet_gradient.hpp"

namespace isotet::core {

namespace {

/// Which later clusters borrow points from each cluster, ascending, and where those points start in the borrower.
struct Borrower {
    std::uint32_t cluster;
    std::uint16_t first_local, points;
};

struct Borrowers {
    std::vector<std::uint64_t> first;
    std::vector<Borrower> list;

    explicit Borrowers(const Packed& packed) : first(packed.clusters() + 1, 0) {
        for (std::size_t c = 0; c < packed.clusters(); ++c)
            for (const Neighbour& n : packed.cluster_links(c).neighbours) first[n.cluster + 1] += n.ghost_points > 0;
        for (std::size_t c = 0; c < packed.clusters(); ++c) first[c + 1] += first[c];
        list.resize(first.back());
        auto next = first;
        for (std::size_t c = 0; c < packed.clusters(); ++c) {
            std::uint16_t local = 0;
            for (const Neighbour& n : packed.cluster_links(c).neighbours) {
                if (n.ghost_points) list[next[n.cluster]++] = {static_cast<std::uint32_t>(c), local, n.ghost_points};
                local = static_cast<std::uint16_t>(local + n.ghost_points);
            }
        }
    }
};

template <class Real>
class Gradients {
public:
    explicit Gradients(Packed& packed) : packed_(packed), borrowers_(packed) {}

    void run() {
        packed_.gradients = SharedBuffer<std::uint32_t>(packed_.points());
        worker_each(packed_.clusters(), 16, [&](std::size_t c) { one_cluster(c); });
    }

private:
    void one_cluster(std::size_t c) {
        const ClusterHeader& h = packed_.headers[c];
        if (packed_.frame) return one_cluster_of_piece(c);
        Point sums[max_cluster_points] = {};
        add_all_tets(c, [&](std::size_t own, const Point& gradient) {
            for (std::size_t axis = 0; axis < 3; ++axis) sums[own][axis] += gradient[axis];
        });
        for (std::size_t k = 0; k < h.own_points; ++k) packed_.gradients[h.first_point + k] = encode_normal(sums[k]);
    }

    /// In an order that all pieces have alike.
    void one_cluster_of_piece(std::size_t c) {
        const ClusterHeader& h = packed_.headers[c];
        std::vector<std::vector<Point>> terms(h.own_points);
        add_all_tets(c, [&](std::size_t own, const Point& gradient) { terms[own].push_back(gradient); });
        for (std::size_t k = 0; k < h.own_points; ++k)
            packed_.gradients[h.first_point + k] = encode_normal(sum_of_terms(terms[k]));
    }

    /// Calls add(own point, term) for all tets of the cluster's own points.
    template <class Add>
    void add_all_tets(std::size_t c, const Add& add) const {
        const ClusterHeader& h = packed_.headers[c];
        add_tets(c, h.ghost_points, h.own_points, add);
        for (std::uint64_t i = borrowers_.first[c]; i < borrowers_.first[c + 1]; ++i) {
            const Borrower& borrower = borrowers_.list[i];
            const auto links = packed_.cluster_links(borrower.cluster);
            add_tets(borrower.cluster, borrower.first_local, borrower.points,
                     [&](std::size_t k, const Point& gradient) {
                         add(links.ghost_points[borrower.first_local + k], gradient);
                     });
        }
    }

    /// Calls add(place among them, term) for the tets of a cluster at its local points [first, first + count).
    template <class Add>
    void add_tets(std::size_t cluster, std::size_t first, std::size_t count, const Add& add) const {
        Real values[max_cluster_points], positions[3 * max_cluster_points];
        load_values(packed_, cluster, values);
        load_positions(packed_, cluster, positions);
        const bool others = packed_.headers[cluster].others() != 0;
        const auto wanted = [&](std::uint8_t corner) {
            return std::size_t{corner} - first < count;
        }; // wraps below first
        for_tets(packed_, cluster, [&](const std::array<std::uint8_t, 4>& v, std::size_t) {
            if (!wanted(v[0]) && !wanted(v[1]) && !wanted(v[2]) && !wanted(v[3])) return;
            if (is_nan(values[v[0]]) || is_nan(values[v[1]]) || is_nan(values[v[2]]) || is_nan(values[v[3]])) return;
            std::array<Point, 4> corners;
            std::array<double, 4> corner_values;
            for (std::size_t k = 0; k < 4; ++k) {
                for (std::size_t axis = 0; axis < 3; ++axis) corners[k][axis] = positions[3 * v[k] + axis];
                corner_values[k] = values[v[k]];
            }
            Point gradient = six_volumes_times_gradient(corners, corner_values);
            // A piece of a twisted cell may be inside out.
            if (others && six_volumes(corners[0], corners[1], corners[2], corners[3]) < 0)
                for (double& x : gradient) x = -x;
            for (const std::uint8_t corner : v)
                if (wanted(corner)) add(corner - first, gradient);
        });
    }

    Packed& packed_;
    Borrowers borrowers_;
};

} // namespace

void store_gradients(Packed& packed) {
    if (packed.single()) Gradients<float>(packed).run();
    else Gradients<double>(packed).run();
    packed.report.gradient_bytes = packed.gradients.bytes();
}

} // namespace isotet::core
