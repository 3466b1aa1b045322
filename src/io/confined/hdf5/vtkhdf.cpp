// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// VTKHDF: unstructured grids, versions 1 and 2, and structured ones, alone or in collections, and overlapping boxes on levels.
#include <algorithm>
#include <limits>
#include <variant>

#include <fmt/core.h>

#include "io/confined/hdf5/hdf5_array.hpp"
#include "io/confined/hdf5/hdf5_walk.hpp"
#include "io/confined/hdf5/vtkhdf_amr.hpp"
#include "io/confined/hdf5/vtkhdf_grid.hpp"
#include "io/confined/hdf5/vtkhdf_structured.hpp"
#include "io/confined/loaders.hpp"
#include "io/files/escape.hpp"
#include "io/pieces/block_choice.hpp"

namespace isotet::io::confined {
namespace {

/// A file of one grid.
Result<Loaded> load_grid(const std::string& path, const ReadOptions& options, Depth depth) {
    const auto rows = Hdf5Rows::open(path);
    if (!rows) return rows.error();
    const HdfGrid grid(path, *rows, "/VTKHDF/");
    Loaded loaded;
    if (auto done = grid.announce_all(loaded.info); !done) return done.error();
    const auto step = choose_step(loaded.info, options);
    if (!step) return step.error();
    loaded.step = *step;
    const auto cells = grid.count_cells(*step);
    if (!cells) return cells.error();
    loaded.info.cells = *cells;
    if (depth == Depth::description) {
        loaded.info.least = grid.least(*step);
        return loaded;
    }
    if (auto done = grid.load(options, *step, "", loaded); !done) return done.error();
    if (loaded.pieces.empty()) return broken(path, "it has no part");
    return loaded;
}

/// A grid of a collection.
struct CollectedGrid {
    std::string name;
    std::variant<HdfGrid, HdfStructured> grid;

    Result<void> announce(FileInfo& info) const {
        if (const auto* unstructured = std::get_if<HdfGrid>(&grid)) return unstructured->announce_all(info);
        std::get<HdfStructured>(grid).announce(info);
        return {};
    }
    Result<std::uint64_t> count_cells(std::size_t step) const {
        const auto* unstructured = std::get_if<HdfGrid>(&grid);
        return unstructured ? unstructured->count_cells(step) : std::get<HdfStructured>(grid).cells();
    }
    LeastCounts least(std::size_t step) const {
        const auto* unstructured = std::get_if<HdfGrid>(&grid);
        return unstructured ? unstructured->least(step) : LeastCounts{};
    }
    Result<void> load(const ReadOptions& options, Loaded& loaded) const {
        if (const auto* unstructured = std::get_if<HdfGrid>(&grid))
            return unstructured->load(options, loaded.step, name + ", ", loaded);
        return std::get<HdfStructured>(grid).load(options, name, loaded);
    }
};

/// The unstructured and structured grids of a collection, in its order.
Result<std::vector<CollectedGrid>> grids_of_collection(const std::string& path, const Hdf5Rows& rows, FileInfo& info) {
    std::vector<std::pair<std::int64_t, std::string>> found;
    for (const std::string& name : groups_of(path, "/VTKHDF")) {
        const std::string type = text_attribute(path, "/VTKHDF/" + name, "Type");
        const auto index = integer_attribute(path, "/VTKHDF/" + name, "Index");
        if (type == "UnstructuredGrid" || is_structured_kind(type))
            found.emplace_back(index.value_or(std::numeric_limits<std::int64_t>::max()), name);
        else if (!type.empty())
            leave_out(info, {"block", name, fmt::format("it is of type {}, which is not read", escaped(type))});
    }
    std::ranges::sort(found);
    std::vector<CollectedGrid> all;
    for (const auto& [index, name] : found) {
        const std::string group = "/VTKHDF/" + name;
        if (text_attribute(path, group, "Type") == "UnstructuredGrid") {
            all.push_back({name, HdfGrid(path, rows, group + "/")});
            continue;
        }
        auto structured = HdfStructured::open(path, group);
        if (!structured) return structured.error();
        all.push_back({name, *std::move(structured)});
    }
    return all;
}

/// A file of several grids, which are blocks.
Result<Loaded> load_collection(const std::string& path, const ReadOptions& options, Depth depth) {
    const auto rows = Hdf5Rows::open(path);
    if (!rows) return rows.error();
    Loaded loaded;
    const auto grids = grids_of_collection(path, *rows, loaded.info);
    if (!grids) return grids.error();
    for (const CollectedGrid& grid : *grids)
        if (auto done = grid.announce(loaded.info); !done) return done.error();
    if (grids->empty()) return broken(path, "it has no grid that is read");
    const auto step = choose_step(loaded.info, options);
    if (!step) return step.error();
    loaded.step = *step;
    for (std::size_t i = 0; i < grids->size(); ++i) {
        const auto cells = (*grids)[i].count_cells(loaded.step);
        if (!cells) return cells.error();
        loaded.info.blocks.push_back({static_cast<std::int64_t>(i + 1), (*grids)[i].name, "data set", *cells});
        if (depth == Depth::description) add(loaded.info.least, (*grids)[i].least(loaded.step));
    }
    const auto chosen = chosen_blocks(loaded.info.blocks, options);
    if (!chosen) return chosen.error();
    for (std::size_t i = 0; i < grids->size() && depth == Depth::arrays; ++i) {
        if (!(*chosen)[i]) continue;
        if (auto done = (*grids)[i].load(options, loaded); !done) return done.error();
    }
    return loaded;
}

Result<Loaded> load_any(const std::string& path, const ReadOptions& options, Depth depth) {
    const std::string type = text_attribute(path, "/VTKHDF", "Type");
    if (type == "PartitionedDataSetCollection" || type == "MultiBlockDataSet")
        return load_collection(path, options, depth);
    if (is_structured_kind(type)) return load_vtkhdf_structured(path, options, depth);
    if (type == "OverlappingAMR") return load_vtkhdf_amr(path, options, depth);
    if (type == "UnstructuredGrid") return load_grid(path, options, depth);
    return broken(path, fmt::format("it is a VTKHDF file of type \"{}\": UnstructuredGrid, ImageData, "
                                    "RectilinearGrid, StructuredGrid, OverlappingAMR, PartitionedDataSetCollection and "
                                    "MultiBlockDataSet are read",
                                    escaped(type)));
}

} // namespace

Result<Loaded> load_vtkhdf(const std::string& path, const ReadOptions& options, Depth depth) {
    const auto names = check_hdf5_names(path, options.allow_outside);
    if (!names) return names.error();
    auto loaded = load_any(path, options, depth);
    for (const LeftOut& item : *names)
        if (loaded) leave_out(loaded->info, item);
    return loaded;
}

} // namespace isotet::io::confined
