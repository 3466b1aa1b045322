// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "card.hpp"
#include "push.h"
#include "vulkan/engine/layout.hpp"
#include "webgpu_kernels.hpp" // made of kernels/*.wgsl by CMakeLists.txt

namespace isotet::web {

namespace {

namespace layout = vulkan::layout;

/// What kernels share with the processor and with Vulkan's: constants, cases, structs.
std::string shared_text() {
    std::string text;
#define ISOTET_SAY(name) text += fmt::format("const " #name " = {}u;\n", layout::name);
    ISOTET_SAY(group_size)
    ISOTET_SAY(max_cluster_points)
    ISOTET_SAY(max_cluster_groups)
    ISOTET_SAY(max_cluster_seams)
    ISOTET_SAY(matrix_words)
    ISOTET_SAY(tied_words)
    ISOTET_SAY(segment_clusters)
    ISOTET_SAY(block_segments)
    ISOTET_SAY(few_edges)
    ISOTET_SAY(pyramid_cases_at)
    ISOTET_SAY(wedge_cases_at)
    ISOTET_SAY(hexahedron_cases_at)
    ISOTET_SAY(own_seams_bits)
    ISOTET_SAY(wide_seams_flag)
#undef ISOTET_SAY
    text += "const tet_cases = array<u32, 16>(";
    for (const core::TetCase& one : core::case_table) text += fmt::format("{}u,", layout::tet_case(one));
    text += ");\nstruct Cluster { page: u32, first_point: u32, first_word: u32, first_group: u32, first_link: u32, "
            "first_mask: u32, points: u32, tets: u32, others: u32, seams: u32 };\nstruct Push {";
#define ISOTET_FLOAT(name) text += #name ": f32, ";
#define ISOTET_UINT(name) text += #name ": u32, ";
    ISOTET_CARD_PUSH(ISOTET_FLOAT, ISOTET_UINT)
#undef ISOTET_FLOAT
#undef ISOTET_UINT
    return text + "};\n";
}

} // namespace

view::Json card_kernels() {
    const std::string common = shared_text() + std::string(kernel_common);
    const std::string cut = common + std::string(kernel_cluster) + std::string(kernel_cut);
    return {{"select", common + std::string(kernel_select)},
            {"count", cut + std::string(kernel_count)},
            {"scan", common + std::string(kernel_scan)},
            {"emit", cut + std::string(kernel_emit)}};
}

} // namespace isotet::web
