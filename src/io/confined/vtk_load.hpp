// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The steps that all of VTK's readers go through, for readers that switch arrays by name.
#pragma once

#include "io/reader.hpp"
#include "io/pieces/block_choice.hpp"
#include "io/pieces/loaded.hpp"
#include "io/confined/vtk_grid.hpp"

namespace isotet::io::confined {

/// Switches on the arrays that the options want; for a description all of them, since these readers tell an array's
/// type only when they have read it.
template <class Reader>
void choose_arrays_by_name(Reader& reader, const ReadOptions& options, FileInfo& info) {
    for (int i = 0; i < reader.GetNumberOfPointArrays(); ++i) {
        const char* name = reader.GetPointArrayName(i);
        const bool want = wanted(options, Association::point, name);
        reader.SetPointArrayStatus(name, want);
        if (!want) announce(info, {name, Association::point, ScalarType::float64, 1});
    }
    for (int i = 0; i < reader.GetNumberOfCellArrays(); ++i) {
        const char* name = reader.GetCellArrayName(i);
        const bool want = wanted(options, Association::cell, name);
        reader.SetCellArrayStatus(name, want);
        if (!want) announce(info, {name, Association::cell, ScalarType::float64, 1});
    }
}

/// Reads the chosen blocks of one time step. `choose(options, info)` switches arrays on; it is called after the reader
/// has looked at the file.
template <class Reader, class Choose>
Result<Loaded> load_with(Reader& reader, const std::string& path, const ReadOptions& options, Depth depth,
                         Choose choose, const char* kind_of_block = "block") {
    Loaded loaded;
    if (auto ready = update_information(reader, path); !ready) return ready.error();
    loaded.info.times = announced_times(reader);
    ReadOptions all = options;
    if (depth == Depth::description) {
        all.point_fields.reset();
        all.cell_fields.reset();
    }
    auto step = choose_step(loaded.info, all);
    if (!step) return step.error();
    loaded.step = *step;
    choose(all, loaded.info);
    if (auto done = update(reader, path, loaded.info.times, loaded.step); !done) return done.error();
    announce_fields(reader.GetOutputDataObject(0), loaded.info);
    announce_blocks(reader.GetOutputDataObject(0), loaded.info, kind_of_block);
    const auto chosen = chosen_blocks(loaded.info.blocks, options);
    if (!chosen) return chosen.error();
    if (depth == Depth::description) return loaded;
    auto pieces = pieces_of(reader.GetOutputDataObject(0), options, loaded.notes);
    if (!pieces) return broken(path, pieces.error().message);
    if (pieces->empty()) return broken(path, "VTK's reader found no grid in it");
    for (std::size_t i = 0; i < pieces->size(); ++i)
        if (i >= chosen->size() || (*chosen)[i]) loaded.pieces.push_back(std::move((*pieces)[i]));
    return loaded;
}

} // namespace isotet::io::confined
