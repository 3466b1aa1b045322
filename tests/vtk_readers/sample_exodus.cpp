// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "vtk_readers/sample_exodus.hpp"

#include <algorithm>

#include <gtest/gtest.h>
#include <vtk_exodusII.h>

namespace isotet::test {
namespace {

int corners_of(const ExodusSample& sample, std::size_t block) {
    return sample.corners.empty() ? 4 : sample.corners[block];
}

std::int64_t cells_of(const ExodusSample& sample, std::size_t block) {
    return static_cast<std::int64_t>(sample.blocks[block].size()) / corners_of(sample, block);
}

template <class Real>
void write(const ExodusSample& sample, const std::string& path) {
    int word = sizeof(Real), stored = sizeof(Real);
    const int file = ex_create(path.c_str(), EX_CLOBBER | sample.format, &word, &stored);
    ASSERT_GE(file, 0);
    const auto count = static_cast<std::int64_t>(sample.nodes.size());
    std::int64_t cells = 0;
    for (std::size_t b = 0; b < sample.blocks.size(); ++b) cells += cells_of(sample, b);
    ex_init_params sizes{};
    sizes.num_dim = 3;
    sizes.num_nodes = count;
    sizes.num_elem = cells;
    sizes.num_elem_blk = static_cast<std::int64_t>(sample.blocks.size());
    sizes.num_elem_sets = static_cast<std::int64_t>(sample.sets.size());
    ex_put_init_ext(file, &sizes);
    std::array<std::vector<Real>, 3> axes;
    for (const auto& node : sample.nodes)
        for (std::size_t axis = 0; axis < 3; ++axis) axes[axis].push_back(static_cast<Real>(node[axis]));
    ex_put_coord(file, axes[0].data(), axes[1].data(), axes[2].data());
    for (std::size_t b = 0; b < sample.blocks.size(); ++b) {
        const auto id = static_cast<ex_entity_id>(10 * (b + 1));
        const int corners = corners_of(sample, b);
        constexpr const char* names[] = {"TETRA", "PYRAMID", "WEDGE", "", "HEX"};
        ex_put_block(file, EX_ELEM_BLOCK, id, names[corners - 4], cells_of(sample, b), corners, 0, 0, 0);
        ex_put_conn(file, EX_ELEM_BLOCK, id, sample.blocks[b].data(), nullptr, nullptr);
        if (b < sample.block_names.size()) ex_put_name(file, EX_ELEM_BLOCK, id, sample.block_names[b].c_str());
    }
    for (const ExodusSample::Set& set : sample.sets) {
        ex_put_set_param(file, EX_ELEM_SET, set.id, static_cast<std::int64_t>(set.cells.size()), 0);
        ex_put_set(file, EX_ELEM_SET, set.id, set.cells.data(), nullptr);
        if (!set.name.empty()) ex_put_name(file, EX_ELEM_SET, set.id, set.name.c_str());
    }
    ex_put_id_map(file, EX_NODE_MAP, sample.node_ids.data());
    ex_put_id_map(file, EX_ELEM_MAP, sample.cell_ids.data());
    if (sample.steps > 0) {
        char names[4][8] = {"disp_x", "disp_y", "disp_z", "temp"};
        char* node_names[] = {names[0], names[1], names[2], names[3]};
        char load[] = "load", drag[] = "drag", lift[] = "lift";
        char* cell_names[] = {load, drag, lift};
        const int variables = sample.more_loads ? 3 : 1;
        ex_put_variable_param(file, EX_NODAL, 4);
        ex_put_variable_names(file, EX_NODAL, 4, node_names);
        ex_put_variable_param(file, EX_ELEM_BLOCK, variables);
        ex_put_variable_names(file, EX_ELEM_BLOCK, variables, cell_names);
        std::vector<int> truth(sample.blocks.size() * static_cast<std::size_t>(variables), 0);
        std::fill_n(truth.begin(), variables, 1);
        ex_put_truth_table(file, EX_ELEM_BLOCK, static_cast<int>(sample.blocks.size()), variables, truth.data());
    }
    for (int step = 0; step < sample.steps; ++step) {
        const Real time = static_cast<Real>(0.5 * step);
        ex_put_time(file, step + 1, &time);
        std::vector<Real> values;
        for (std::int64_t node = 0; node < count; ++node)
            values.push_back(step >= sample.filled_from ? static_cast<Real>(9.9692099683868690e+36)
                                                        : static_cast<Real>(10 * step + static_cast<int>(node)));
        for (int variable = 1; variable <= 4; ++variable)
            ex_put_var(file, step + 1, EX_NODAL, variable, 1, count, values.data());
        for (int variable = 1; variable <= (sample.more_loads ? 3 : 1); ++variable)
            ex_put_var(file, step + 1, EX_ELEM_BLOCK, variable, 10, cells_of(sample, 0), values.data());
    }
    ASSERT_GE(ex_close(file), 0);
}

} // namespace

void write_exodus(const ExodusSample& sample, const std::string& path) {
    if (sample.single) write<float>(sample, path);
    else write<double>(sample, path);
}

} // namespace isotet::test
