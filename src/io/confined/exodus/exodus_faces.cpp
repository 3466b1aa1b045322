// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Polyhedra in Exodus: element blocks NFACED of faces in face blocks NSIDED.
#include <algorithm>
#include <numeric>

#include <fmt/core.h>

#include "io/confined/exodus/exodus_file.hpp"
#include "io/files/escape.hpp"

namespace isotet::io::confined {

Result<ExodusFile::Ragged> ExodusFile::read_ragged(const std::string& numbers, const std::string& counts,
                                                   std::uint64_t count, std::uint64_t size,
                                                   const std::string& owner) const {
    if (count == 0) return Ragged{};
    auto each = file_->numbers<std::int32_t>(counts);
    if (!each || each->size() != count) return failed(fmt::format("the counts ({}) of {}", counts, owner));
    const bool sound = std::ranges::all_of(*each, [](int n) { return n >= 0; });
    const std::int64_t sum = std::accumulate(each->begin(), each->end(), std::int64_t{0});
    if (!sound || static_cast<std::uint64_t>(sum) != size)
        return failed(fmt::format("{}, whose counts ({}) have a sum of {} for {} numbers,", owner, counts, sum, size));
    auto all = file_->numbers<std::int64_t>(numbers);
    if (!all || all->size() != size) return failed(fmt::format("the connectivity ({}) of {}", numbers, owner));
    return Ragged{*std::move(all), std::vector<int>(each->begin(), each->end())};
}

Result<ExodusFile::Ragged> ExodusFile::faces() {
    const std::uint64_t blocks = file_->dimension("num_fa_blk").value_or(0);
    if (blocks > std::uint64_t{1} << 20) return failed(fmt::format("a list of {} face blocks", blocks));
    Ragged all;
    for (std::uint64_t i = 1; i <= blocks; ++i) {
        const std::string conn = fmt::format("fbconn{}", i), owner = fmt::format("face block {}", i);
        const auto faces = file_->dimension(fmt::format("num_fa_in_blk{}", i)),
                   nodes = file_->dimension(fmt::format("num_nod_per_fa{}", i));
        if (!faces) continue; // an empty one
        const std::string topology = file_->text_attribute(conn, "elem_type").value_or("");
        if (topology != "nsided" && topology != "NSIDED" && topology != "Nsided")
            return failed(fmt::format("{} of \"{}\", not \"nsided\",", owner, escaped(topology)));
        const auto own = read_ragged(conn, fmt::format("fbepecnt{}", i), *faces, nodes.value_or(0), owner);
        if (!own) return own;
        all.numbers.insert(all.numbers.end(), own->numbers.begin(), own->numbers.end());
        all.counts.insert(all.counts.end(), own->counts.begin(), own->counts.end());
    }
    return all;
}

Result<ExodusFile::Ragged> ExodusFile::faces_of(const Block& block) {
    return read_ragged(fmt::format("facconn{}", block.number), fmt::format("ebepecnt{}", block.number), block.cells,
                       block.faces, fmt::format("element block {}", block.id));
}

} // namespace isotet::io::confined
