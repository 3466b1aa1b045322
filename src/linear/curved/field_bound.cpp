// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The bound of any field on a refined grid.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <vector>

#include <fmt/format.h>

#include <isotet/linear_cells.hpp>

#include "base/carry_out.hpp"
#include "base/errors.hpp"
#include "linear/curved/node_values.hpp"
#include "linear/place.hpp"

namespace isotet {

namespace linear {

namespace {

/// The places of a linear grid's points in the quadratic tets that have them.
class PlaceFinder {
public:
    explicit PlaceFinder(const LinearGrid& linear)
        : refined_(linear.refined), known_(linear.user_points + linear.derived.count()) {}

    QuadraticTet tet(std::size_t index) const {
        QuadraticTet tet{};
        std::memcpy(tet.data(), refined_.nodes.as<Node>().data() + 10 * index, sizeof tet);
        return tet;
    }

    Place find(std::uint64_t point, std::size_t index, const QuadraticTet& in) const {
        if (point < known_) {
            const auto node = static_cast<std::size_t>(std::ranges::find(in, static_cast<Node>(point)) - in.begin());
            if (node < 4) return corner_places[node];
            if (node < 10)
                return halfway(corner_places[tet_edges[node - 4][0]], corner_places[tet_edges[node - 4][1]]).value();
            return corner_places[0];
        }
        const std::size_t row = point - known_;
        const Place place = place_at(refined_.places, row);
        const std::size_t parent = refined_.parents.as<std::uint32_t>()[row];
        return parent == index ? place : moved(place, tet(parent), in);
    }

private:
    /// The place of a point of a common face or edge.
    static Place moved(const Place& place, const QuadraticTet& from, const QuadraticTet& to) {
        const auto steps = steps_of(place);
        Place out{};
        for (std::size_t i = 0; i < 4; ++i) {
            if (steps[i] == 0) continue;
            const auto corner = static_cast<std::size_t>(std::find(to.begin(), to.begin() + 4, from[i]) - to.begin());
            if (corner < 3) out[corner] = steps[i];
        }
        return out;
    }

    const RefinedPoints& refined_;
    std::uint64_t known_;
};

double largest_deviation(const LinearGrid& linear, const NodeValues& values, const Progress& progress) {
    const PlaceFinder finder(linear);
    const auto children = linear.refined.children.as<std::uint32_t>();
    const auto corners = linear.grid.cells.connectivity.as<std::int32_t>();
    constexpr std::size_t per_piece = 4096;
    const std::size_t pieces = (children.size() + per_piece - 1) / per_piece;
    std::vector<std::uint64_t> first(pieces + 1, 0);
    for (std::size_t i = 0; i < children.size(); ++i) first[i / per_piece + 1] += children[i];
    for (std::size_t p = 0; p < pieces; ++p) first[p + 1] += first[p];
    std::vector<double> largest(pieces, 0);
    core::parallel_pieces(pieces, 1, progress, [&](std::size_t begin, std::size_t end) {
        for (std::size_t piece = begin; piece < end; ++piece) {
            std::uint64_t cell = first[piece];
            for (std::size_t i = piece * per_piece; i < std::min(children.size(), (piece + 1) * per_piece); ++i) {
                if (children[i] == 0) continue;
                const QuadraticTet tet = finder.tet(i);
                const auto bezier = to_bezier(values.of(tet));
                for (std::uint32_t child = 0; child < children[i]; ++child, ++cell) {
                    std::array<Place, 4> at{};
                    for (std::size_t k = 0; k < 4; ++k)
                        at[k] = finder.find(static_cast<std::uint64_t>(corners[4 * cell + k]), i, tet);
                    for (const auto& [a, b] : tet_edges) {
                        const double deviation = deviation_between(bezier, at[a], at[b]);
                        if (deviation > largest[piece]) largest[piece] = deviation; // not NaN
                    }
                }
            }
        }
    });
    return largest.empty() ? 0 : *std::ranges::max_element(largest);
}

} // namespace

} // namespace linear

Result<double> field_bound(const LinearGrid& linear, const Array& values, const Run& run) {
    return core::carry_out("bounding the error", run, [&](const Progress& progress) -> Result<double> {
        if (values.components() != 1 || values.tuples() != linear.user_points)
            return invalid_argument(
                fmt::format("there are {} tuples of {} components, but there must be one scalar for each "
                            "of the {} points",
                            values.tuples(), values.components(), linear.user_points));
        if (linear.refined.children.empty()) return 0.0;
        auto longer = linear.extend(values);
        if (!longer) return longer.error();
        const Array known(longer->type(), longer->data(), linear.user_points + linear.derived.count(), 1,
                          std::make_shared<Array>(*longer));
        const linear::NodeValues nodes(known, linear.refined.hidden);
        const double largest = linear::largest_deviation(linear, nodes, progress);
        if (progress.cancelled()) return Error{ErrorCode::cancelled, "bounding the error was cancelled"};
        return 1.5 * largest;
    });
}

} // namespace isotet
