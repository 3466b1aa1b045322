// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// isotet as a contestant of the race.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include <isotet/extract.hpp>
#include <isotet/grid.hpp>
#include <isotet/pack.hpp>

#include "bench/protocol.hpp"

namespace isotet::bench {

/// Commands: open FOLDER THREADS; pack NAME [gradients|source_cells]...; extract NAME ISOVALUE [ATTRIBUTE]...;
/// once ISOVALUE; set_field NAME; copy THREADS; arrays SOURCE FIELD FOLDER THREADS. NAME is that of a packed grid:
/// several may be kept. ATTRIBUTE: gradient_normals, face_normals, point_field, source_cells, edge_ends;
/// or what the processor shall do without, where it has better: avx2, portable.
class IsotetContestant {
public:
    Reply answer(const Words& words);

private:
    Reply open(const std::string& folder, int threads);
    Reply pack_as(const std::string& name, const Words& options);
    Reply extract_from(const std::string& name, double isovalue, const Words& attributes);
    Reply extract_direct(double isovalue);
    Reply set_field(const std::string& name);

    PackedGrid& packed(const std::string& name);
    std::uint64_t input_bytes() const;

    int threads_ = 0;
    Grid grid_;
    PointField field_, negative_;
    std::map<std::string, PackedGrid> packed_;
};

} // namespace isotet::bench
