// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Polyhedra in Exodus: element blocks NFACED of faces in face blocks NSIDED.
#include <algorithm>
#include <numeric>

#include <fmt/core.h>
#include <vtk_exodusII.h>

#include "io/confined/exodus/exodus_file.hpp"
#include "io/files/escape.hpp"

namespace isotet::io::confined {

Result<ExodusFile::Ragged> ExodusFile::read_ragged(int entity, std::int64_t id, std::uint64_t count,
                                                   std::uint64_t size) const {
    const auto type = static_cast<ex_entity_type>(entity);
    const char* const what = type == EX_FACE_BLOCK ? "face" : "element";
    Ragged ragged{std::vector<std::int64_t>(size), std::vector<int>(count)};
    if (count == 0) return ragged;
    if (ex_get_entity_count_per_polyhedra(number_, type, id, ragged.counts.data()) < 0)
        return failed(
            fmt::format("the number of {} in {} block {}", type == EX_FACE_BLOCK ? "nodes" : "faces", what, id));
    const bool sound = std::ranges::all_of(ragged.counts, [](int n) { return n >= 0; });
    const std::int64_t sum = std::accumulate(ragged.counts.begin(), ragged.counts.end(), std::int64_t{0});
    if (!sound || static_cast<std::uint64_t>(sum) != size)
        return failed(fmt::format("{} block {}, whose {} have {} entries of {},", what, id,
                                  type == EX_FACE_BLOCK ? "faces" : "elements", sum, size));
    auto* const nodes = type == EX_FACE_BLOCK ? ragged.numbers.data() : nullptr;
    auto* const faces = type == EX_FACE_BLOCK ? nullptr : ragged.numbers.data();
    if (size > 0 && ex_get_conn(number_, type, id, nodes, nullptr, faces) < 0)
        return failed(fmt::format("the connectivity of {} block {}", what, id));
    return ragged;
}

Result<ExodusFile::Ragged> ExodusFile::faces() {
    ex_init_params counts{};
    if (ex_get_init_ext(number_, &counts) < 0 || counts.num_face_blk < 0 || counts.num_face_blk > 1 << 20)
        return failed("the number of face blocks");
    std::vector<std::int64_t> ids(static_cast<std::size_t>(counts.num_face_blk));
    if (!ids.empty() && ex_get_ids(number_, EX_FACE_BLOCK, ids.data()) < 0)
        return failed("the numbers of the face blocks");
    Ragged all;
    for (const std::int64_t id : ids) {
        ex_block block{};
        block.id = id;
        block.type = EX_FACE_BLOCK;
        if (ex_get_block_param(number_, &block) < 0 || block.num_entry < 0 || block.num_nodes_per_entry < 0)
            return failed(fmt::format("face block {}", id));
        const auto count = static_cast<std::uint64_t>(block.num_entry);
        block.topology[MAX_STR_LENGTH] = '\0';
        const std::string topology = block.topology;
        if (topology != "nsided" && topology != "NSIDED" && topology != "Nsided")
            return failed(fmt::format("face block {} of \"{}\", not \"nsided\",", id, escaped(topology)));
        const auto own = read_ragged(EX_FACE_BLOCK, id, count, static_cast<std::uint64_t>(block.num_nodes_per_entry));
        if (!own) return own;
        all.numbers.insert(all.numbers.end(), own->numbers.begin(), own->numbers.end());
        all.counts.insert(all.counts.end(), own->counts.begin(), own->counts.end());
    }
    return all;
}

Result<ExodusFile::Ragged> ExodusFile::faces_of(const Block& block) {
    return read_ragged(EX_ELEM_BLOCK, block.id, block.cells, block.faces);
}

} // namespace isotet::io::confined
