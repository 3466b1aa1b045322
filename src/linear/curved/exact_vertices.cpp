// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "linear/curved/exact_vertices.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>
#include <vector>

#include "base/buffer.hpp"
#include "base/parallel.hpp"
#include "linear/curved/node_values.hpp"
#include "linear/place.hpp"

namespace isotet::linear {

namespace {

constexpr std::size_t vertex_grain = 1 << 13;
constexpr std::uint64_t no_triangle = std::numeric_limits<std::uint64_t>::max();

/// The first triangle of each vertex.
std::vector<std::uint64_t> first_triangles(const Surface& surface) {
    std::vector<std::uint64_t> first(surface.vertex_count(), no_triangle);
    surface.triangles.visit([&](auto corners) {
        core::parallel_each(corners.size(), vertex_grain, [&](std::size_t i) {
            std::atomic_ref least(first[static_cast<std::size_t>(corners[i])]);
            const std::uint64_t triangle = i / 3;
            std::uint64_t seen = least.load(std::memory_order_relaxed);
            while (triangle < seen && !least.compare_exchange_weak(seen, triangle, std::memory_order_relaxed)) {}
        });
    });
    return first;
}

/// Where in [0, 1] a + (b - a) t + 4 bump t (1 - t) is c, for a <= c <= b.
double root_of(double a, double b, double bump, double c) {
    if (a >= c) return 0; // as stored it was below
    if (b < c) return 1;
    const double square = -4 * bump, slope = b - a + 4 * bump, at_zero = a - c;
    const double root = std::sqrt(std::max(0.0, slope * slope - 4 * square * at_zero));
    const double t = slope >= 0 ? -2 * at_zero / (slope + root) : (root - slope) / (2 * square);
    return std::clamp(t, 0.0, 1.0);
}

/// The quadratic tets, and where points of the linear grid lie in them.
class Places {
public:
    explicit Places(const LinearGrid& linear)
        : before_(linear.grid.points.tuples() - linear.refined.count()),
          places_(linear.refined.places),
          parents_(linear.refined.parents.as<std::uint32_t>()),
          nodes_(linear.refined.nodes.as<Node>()),
          ends_(linear.refined.children.tuples()) {
        const auto children = linear.refined.children.as<std::uint32_t>();
        std::uint64_t sum = 0;
        for (std::size_t i = 0; i < ends_.size(); ++i) ends_[i] = sum += children[i];
    }

    /// How many points there were before refined ones.
    std::uint64_t before() const { return before_; }

    /// The quadratic tet that a tet of the linear grid is a part of.
    std::size_t parent_of(std::uint64_t cell) const {
        return static_cast<std::size_t>(std::ranges::upper_bound(ends_, cell) - ends_.begin());
    }

    QuadraticTet tet(std::size_t parent) const {
        QuadraticTet out{};
        std::memcpy(out.data(), &nodes_[10 * parent], sizeof out);
        return out;
    }

    /// Weights of the corners of a quadratic tet at a point that lies in it, in steps of 2^-30.
    std::array<std::int64_t, 4> weights(const QuadraticTet& tet, std::size_t parent, std::uint64_t point) const {
        std::array<std::int64_t, 4> out{};
        if (point < before_) {
            const auto node = static_cast<std::size_t>(std::ranges::find(tet, static_cast<Node>(point)) - tet.begin());
            if (node < 4) out[node] = whole_weight;
            else if (node < 10) out[tet_edges[node - 4][0]] = out[tet_edges[node - 4][1]] = whole_weight / 2;
            return out;
        }
        const std::size_t row = point - before_, owner = parents_[row];
        const auto steps = steps_of(place_at(places_, row));
        if (owner == parent) {
            std::ranges::copy(steps, out.begin());
            return out;
        }
        const Node* const corners = &nodes_[10 * owner]; // of a neighbour that has the point, too
        for (std::size_t i = 0; i < 4; ++i)
            for (std::size_t k = 0; k < 4; ++k)
                if (steps[i] > 0 && tet[k] == corners[i]) out[k] = steps[i];
        return out;
    }

private:
    std::uint64_t before_;
    const Array& places_;
    std::span<const std::uint32_t> parents_;
    std::span<const Node> nodes_;
    std::vector<std::uint64_t> ends_; ///< behind the linear tets of each quadratic one
};

/// An edge of a linear tet in a quadratic one.
struct Chord {
    std::array<std::uint64_t, 2> ends{};
    QuadraticTet tet{};
    std::array<double, 6> part{}; ///< how much of each edge's bump is the chord's

    Chord(const Places& places, std::array<std::uint64_t, 2> points, std::size_t parent)
        : ends(points), tet(places.tet(parent)) {
        const auto from = places.weights(tet, parent, ends[0]), to = places.weights(tet, parent, ends[1]);
        std::array<double, 4> along{};
        for (std::size_t i = 0; i < 4; ++i) along[i] = static_cast<double>(to[i] - from[i]) / whole_weight;
        for (std::size_t e = 0; e < 6; ++e) part[e] = -along[tet_edges[e][0]] * along[tet_edges[e][1]];
    }

    /// How far a quadratic field is above the mean of the chord's ends at its middle. Edges without a part in it, which
    /// a neighbour may not have, are not looked at.
    double bump(const NodeValues& values) const {
        double sum = 0;
        for (std::size_t e = 0; e < 6; ++e) {
            const Node middle = tet[4 + e];
            if (part[e] == 0 || middle == mean_node) continue;
            sum += part[e] * (values[middle] - (values[tet[tet_edges[e][0]]] + values[tet[tet_edges[e][1]]]) / 2);
        }
        return sum;
    }
};

/// A component of an array of one tuple a point of the linear grid.
class CurvedValues {
public:
    CurvedValues(const Array& values, const LinearGrid& linear, std::uint64_t before, std::size_t component)
        : all_(&values),
          component_(component),
          nodes_(first_tuples(values, before), linear.refined.hidden, component) {}

    double end(const Chord& chord, std::size_t i) const { return all_->at(chord.ends[i], component_); }
    double bump(const Chord& chord) const { return chord.bump(nodes_); }
    double at(const Chord& chord, double t) const {
        const double a = end(chord, 0), b = end(chord, 1);
        return a + (b - a) * t + 4 * bump(chord) * t * (1 - t);
    }

private:
    static Array first_tuples(const Array& values, std::uint64_t count) {
        return Array(values.type(), values.data(), count, values.components(), std::make_shared<Array>(values));
    }

    const Array* all_;
    std::size_t component_;
    NodeValues nodes_;
};

/// An array of a surface that is written anew, and where its components come from.
class Moved {
public:
    Moved(Array& array, const Array& values, const LinearGrid& linear, std::uint64_t before) : Moved(array) {
        for (std::size_t c = 0; c < values.components(); ++c) from_.emplace_back(values, linear, before, c);
    }
    explicit Moved(Array& array) {
        array.visit([&]<class T>(std::span<const T> old) {
            core::Buffer<T> copy(old.size());
            std::memcpy(copy.data(), old.data(), old.size_bytes());
            write_ = [](void* data, std::size_t i, double value) { static_cast<T*>(data)[i] = static_cast<T>(value); };
            data_ = copy.data();
            array = std::move(copy).to_array(array.components());
        });
    }
    void put(std::size_t vertex, const Chord& chord, double t) const {
        for (std::size_t c = 0; c < from_.size(); ++c) write_(data_, vertex * from_.size() + c, from_[c].at(chord, t));
    }
    void put(std::size_t vertex, double value) const { write_(data_, vertex, value); }

private:
    void* data_ = nullptr;
    void (*write_)(void*, std::size_t, double) = nullptr;
    std::vector<CurvedValues> from_;
};

} // namespace

Result<void> move_to_roots(const LinearGrid& linear, const Array& values, std::span<const Field> carried,
                           double isovalue, Surface& surface, const Progress& progress) {
    const Places places(linear);
    const CurvedValues field(values, linear, places.before(), 0);
    std::vector<Moved> moved;
    moved.emplace_back(surface.positions, linear.grid.points, linear, places.before());
    for (std::size_t i = 0; i < carried.size(); ++i)
        moved.emplace_back(surface.point_fields[i].values, carried[i].values, linear, places.before());
    const Moved weights(surface.edge_weights);
    const std::vector<std::uint64_t> triangles = first_triangles(surface);
    const auto ends = surface.edge_ends.as<std::int64_t>();
    const auto cells = surface.source_cells.as<std::int64_t>();
    core::parallel_pieces(surface.vertex_count(), vertex_grain, progress, [&](std::size_t begin, std::size_t end) {
        for (std::size_t vertex = begin; vertex < end; ++vertex) {
            const std::array points{static_cast<std::uint64_t>(ends[2 * vertex]),
                                    static_cast<std::uint64_t>(ends[2 * vertex + 1])};
            if (points[0] == points[1] || triangles[vertex] == no_triangle) continue;
            const auto cell = static_cast<std::uint64_t>(cells[triangles[vertex]]);
            const Chord chord(places, points, places.parent_of(cell));
            const double t = root_of(field.end(chord, 0), field.end(chord, 1), field.bump(chord), isovalue);
            for (const Moved& array : moved) array.put(vertex, chord, t);
            weights.put(vertex, t);
        }
    });
    if (progress.cancelled()) return Error{ErrorCode::cancelled, "moving vertices was cancelled"};
    return {};
}

} // namespace isotet::linear
