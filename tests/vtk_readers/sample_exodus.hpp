// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Small Exodus files through the Exodus library: two blocks of tetrahedra that share three nodes.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace isotet::test {

struct ExodusSample {
    std::vector<std::array<double, 3>> nodes = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, -1}};
    std::vector<std::vector<int>> blocks = {{1, 2, 3, 4}, {1, 3, 2, 5}}; ///< corners from 1
    std::vector<int> corners = {}; ///< of each cell of a block: 4 to 8; empty: 4 of all
    std::vector<int> node_ids = {1, 2, 3, 4, 5};
    std::vector<int> cell_ids = {1, 2};
    bool single = false; ///< float32
    int steps = 2;       ///< with disp_x, disp_y, disp_z and temp on nodes: 10 * step + node; load on the first block
                         ///< only
    bool more_loads = false; ///< two more variables like load
    int filled_from = 1000; ///< from this step on all values are netCDF's fill value
    int format = 0;      ///< a flag of ex_create: EX_64BIT_OFFSET, EX_NETCDF4 and so on
    std::vector<std::string> block_names; ///< empty: none has a name; ids are 10, 20 and so on
    struct Set {
        std::int64_t id;
        std::string name;
        std::vector<int> cells; ///< from 1
    };
    std::vector<Set> sets = {};
};

void write_exodus(const ExodusSample& sample, const std::string& path);

} // namespace isotet::test
