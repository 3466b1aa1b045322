// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "packed/source_cells.hpp"

#include <cstdint>
#include <vector>

#include "base/buffer.hpp"
#include "base/parallel.hpp"

namespace isotet::core {

Array source_cells_of(const Packed& packed) {
    std::vector<std::uint64_t> first{0};
    for (const ClusterHeader& h : packed.headers) first.push_back(first.back() + h.tets() + h.others());
    Buffer<std::uint64_t> out(first.back());
    parallel_each(packed.clusters(), 64, [&](std::size_t c) {
        const ClusterHeader& h = packed.headers[c];
        std::uint64_t* to = out.data() + first[c];
        for (std::size_t word = 0; word < h.tets(); ++word) *to++ = packed.user_cell(h.first_word + word);
        packed.for_other_cells(c, [&](const StoredCell& cell) { *to++ = packed.user_cell(h.first_word + cell.word); });
    });
    return std::move(out).to_array();
}

} // namespace isotet::core
