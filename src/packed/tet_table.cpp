// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "packed/tet_table.hpp"

#include <limits>

#include <fmt/core.h>

#include "base/parallel.hpp"

namespace isotet::core {

Result<TetTable> make_tet_table(const Packed& packed) {
    if (!packed.single())
        return Error{ErrorCode::invalid_argument,
                     "the grid is packed in double, but tables hold float32: pack it in single precision"};
    std::uint64_t tets = 0, others = 0;
    for (const ClusterHeader& header : packed.headers) {
        tets += header.tets();
        others += header.others();
    }
    if (others)
        return Error{ErrorCode::invalid_argument,
                     fmt::format("the grid is packed with {} pyramids, wedges and hexahedra as they are, but tables "
                                 "hold tets: pack it with split_cells",
                                 others)};
    constexpr std::uint64_t limit = std::numeric_limits<std::uint32_t>::max();
    if (tets >= limit)
        return Error{ErrorCode::invalid_data,
                     fmt::format("the grid has {} tets, but tables hold {} at most", tets, limit - 1)};

    TetTable table;
    table.first_tet = Buffer<std::uint32_t>(packed.clusters() + 1);
    std::uint32_t next = 0;
    for (std::size_t c = 0; c < packed.clusters(); ++c) {
        table.first_tet[c] = next;
        next += static_cast<std::uint32_t>(packed.headers[c].tets());
    }
    table.first_tet[packed.clusters()] = next;
    table.tets = Buffer<std::array<std::uint32_t, 4>>(tets);
    parallel_each(packed.clusters(), 64, [&](std::size_t c) {
        std::array<std::uint64_t, max_cluster_points> locals;
        local_points(packed, c, locals.data());
        auto* out = table.tets.data() + table.first_tet[c];
        for (const StoredTet& tet : packed.cluster_tets(c)) {
            for (std::size_t k = 0; k < 4; ++k) (*out)[k] = static_cast<std::uint32_t>(locals[tet.corners[k]]);
            ++out;
        }
    });
    const auto& reals = packed.as<float>();
    table.points = Buffer<std::array<float, 4>>(packed.points());
    parallel_ranges(packed.points(), 1 << 16, [&](std::size_t begin, std::size_t end) {
        for (std::size_t p = begin; p < end; ++p)
            table.points[p] = {reals.positions[3 * p], reals.positions[3 * p + 1], reals.positions[3 * p + 2],
                               reals.values[p]};
    });
    return table;
}

} // namespace isotet::core
