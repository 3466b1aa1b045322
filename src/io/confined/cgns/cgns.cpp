// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// CGNS in ADF or HDF5, through the tree of nodes that the library in VTK reads; zones are pieces.
#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "io/confined/cgns/cgns_patches.hpp"
#include "io/confined/cgns/cgns_solutions.hpp"
#include "io/confined/cgns/cgns_zone.hpp"
#include "io/confined/hdf5/hdf5_walk.hpp"
#include "io/confined/length_check.hpp"
#include "io/confined/loaders.hpp"
#include "io/confined/progress.hpp"
#include "io/files/escape.hpp"
#include "io/files/time_values.hpp"
#include "io/pieces/block_choice.hpp"
#include "io/reader.hpp"
#include "io/vtk_xml/load.hpp"

namespace isotet::io::confined {
namespace {

struct CgnsBase {
    std::string name;
    std::vector<double> times;
    std::vector<std::vector<std::string>> zones; ///< those of each step; empty: all at all steps
};

void read_steps(const CgnsTree& tree, const CgnsNode& iterative, CgnsBase& base) {
    constexpr std::size_t letters_of_name = 32;
    const std::vector<CgnsNode> parts = tree.children(iterative);
    auto node = child_named(parts, "TimeValues");
    if (!node) node = child_named(parts, "IterationValues");
    if (node)
        if (const auto times = tree.numbers(*node)) base.times = time_values(*times);
    const auto pointers = child_named(parts, "ZonePointers");
    if (!pointers || base.times.empty()) return;
    const std::vector<std::string> names = tree.texts(*pointers, letters_of_name);
    const std::size_t most = names.size() / base.times.size();
    if (most == 0 || most * base.times.size() != names.size()) return;
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (i % most == 0) base.zones.emplace_back();
        if (!names[i].empty() && names[i] != "Null") base.zones.back().push_back(names[i]);
    }
}

std::vector<CgnsBase> bases_of(const CgnsTree& tree) {
    std::vector<CgnsBase> bases;
    for (const CgnsNode& node : tree.children(tree.root())) {
        if (node.label != "CGNSBase_t") continue;
        CgnsBase& base = bases.emplace_back();
        base.name = node.name;
        if (const auto iterative = child_labelled(tree.children(node), "BaseIterativeData_t"))
            read_steps(tree, *iterative, base);
    }
    return bases;
}

class CgnsFile {
public:
    CgnsFile(const std::string& path, const CgnsTree& tree) : path_(path), tree_(tree), bases_(bases_of(tree)) {}

    Result<Loaded> load(const ReadOptions& options, Depth depth);

private:
    Result<void> describe(Loaded& loaded, std::optional<std::size_t> only);
    Result<Piece> read_zone(std::size_t at, const ReadOptions& options, std::size_t step,
                            core::PatchList& patch_numbers, Loaded& loaded) const;
    Result<void> read_patches(const CgnsZone& zone, core::PatchList& numbers, Loaded& loaded, Grid& grid) const;
    bool is_there(const CgnsZone& zone, std::size_t step) const;
    LeastCounts least_of(const ReadOptions& options) const;
    std::size_t step_of(const CgnsZone& zone, std::size_t step) const {
        return std::min(step, std::max<std::size_t>(bases_[zone.base].times.size(), 1) - 1);
    }
    Error wrong(const CgnsZone& zone, const Error& error) const {
        if (error.code != ErrorCode::invalid_data || error.message.starts_with(escaped(path_))) return error;
        return broken(path_, fmt::format("zone \"{}\": {}", escaped(zone.name), error.message));
    }

    /// The one that is read without a choice: the first that has a zone of cells with a volume, or else the first.
    std::size_t usual_base() const {
        const auto found = std::ranges::find_if(
            zones_, [](const CgnsZone& zone) { return zone.cell_dimension == 3 && zone.has_points(); });
        return found == zones_.end() ? 0 : found->base;
    }

    const std::string& path_;
    const CgnsTree& tree_;
    std::vector<CgnsBase> bases_;
    std::vector<CgnsZone> zones_;
    std::vector<CgnsCounts> counts_; ///< of each zone
    std::vector<CgnsSolutions> solutions_;
};

/// `only`   the step whose fields are told; nothing: those of all steps
Result<void> CgnsFile::describe(Loaded& loaded, std::optional<std::size_t> only) {
    auto zones = cgns_zones(tree_, path_);
    if (!zones) return zones.error();
    zones_ = *std::move(zones);
    if (zones_.empty()) return broken(path_, "it has no zones");
    for (const CgnsBase& base : bases_)
        if (loaded.info.times.empty()) loaded.info.times = base.times;
    for (const CgnsZone& zone : zones_) {
        CgnsCounts counts;
        if (zone.is_structured) {
            std::vector<std::uint64_t> size = zone.points;
            size.resize(3, 1);
            counts.cells = vtk_xml::cells_in_box({size[0], size[1], size[2]});
        } else {
            const auto found = count_cgns_cells(tree_, zone);
            if (!found) return wrong(zone, found.error());
            counts = *found;
        }
        loaded.info.blocks.push_back(
            {static_cast<std::int64_t>(loaded.info.blocks.size() + 1), zone.name, "zone", counts.cells});
        counts_.push_back(counts);
        solutions_.emplace_back(tree_, zone, bases_[zone.base].times.size(), counts);
        if (!only) solutions_.back().announce(loaded.info, {});
        else if (is_there(zone, *only)) solutions_.back().announce(loaded.info, step_of(zone, *only));
    }
    return {};
}

bool CgnsFile::is_there(const CgnsZone& zone, std::size_t step) const {
    const CgnsBase& base = bases_[zone.base];
    if (base.zones.empty()) return true;
    const auto& names = base.zones[step_of(zone, step)];
    const auto is_named = [&](const std::vector<std::string>& at) {
        return std::ranges::find(at, zone.node.name) != at.end();
    };
    return is_named(names) || std::ranges::none_of(base.zones, is_named);
}

/// Those that are broken are left out.
Result<void> CgnsFile::read_patches(const CgnsZone& zone, core::PatchList& numbers, Loaded& loaded, Grid& grid) const {
    auto patches = cgns_patches(tree_, zone, numbers);
    if (patches) grid.patches = *std::move(patches);
    else if (patches.error().code != ErrorCode::invalid_data) return patches.error();
    else leave_out(loaded.info, {"patch", "boundary conditions of " + zone.name, patches.error().message});
    return {};
}

Result<Piece> CgnsFile::read_zone(std::size_t at, const ReadOptions& options, std::size_t step,
                                  core::PatchList& patch_numbers, Loaded& loaded) const {
    const CgnsZone& zone = zones_[at];
    const CgnsSolutions& solutions = solutions_[at];
    Piece piece;
    piece.name = zone.name;
    auto points = cgns_points(tree_, zone, solutions.coordinates_at(step_of(zone, step)));
    if (!points) return wrong(zone, points.error());
    piece.grid.points = *std::move(points);
    CgnsCells cells;
    if (zone.is_structured) {
        std::vector<std::uint64_t> size = zone.points;
        size.resize(3, 1);
        auto hexahedra = vtk_xml::cells_of_box({size[0], size[1], size[2]}, loaded.notes);
        if (!hexahedra) return hexahedra.error();
        piece.grid.cells = *std::move(hexahedra);
    } else {
        auto read = cgns_cells(tree_, zone, loaded.notes);
        if (!read) return wrong(zone, read.error());
        cells = *std::move(read);
        piece.grid.cells = cells.cells;
    }
    if (options.patches)
        if (auto read = read_patches(zone, patch_numbers, loaded, piece.grid); !read) return read.error();
    solutions.read(options, step_of(zone, step), cells, piece.grid, loaded.info);
    return piece;
}

/// Of the zones that are read without a choice.
LeastCounts CgnsFile::least_of(const ReadOptions& options) const {
    LeastCounts all;
    for (std::size_t i = 0; i < zones_.size(); ++i) {
        const CgnsZone& zone = zones_[i];
        if (zone.base != usual_base() || !zone.has_points() || !is_there(zone, options.step.value_or(0))) continue;
        const bool listed = !zone.is_structured; // elements of blocks are made
        add(all, {zone.point_count(), listed ? counts_[i].cells : 0, listed ? counts_[i].corners : 0,
                  ScalarType::float64, true});
    }
    return all;
}

Result<Loaded> CgnsFile::load(const ReadOptions& options, Depth depth) {
    Loaded loaded;
    const bool described = depth == Depth::description;
    if (auto done = describe(loaded, described ? options.step : std::nullopt); !done) return done.error();
    const auto chosen = chosen_blocks(loaded.info.blocks, options);
    if (!chosen) return chosen.error();
    if (described) {
        loaded.info.least = least_of(options);
        return loaded;
    }
    const auto step = choose_step(loaded.info, options);
    if (!step) return step.error();
    loaded.step = *step;
    const std::size_t base = usual_base();
    if (bases_.size() > 1 && options.blocks.empty()) {
        std::vector<std::string> others;
        for (std::size_t i = 0; i < bases_.size(); ++i)
            if (i != base) others.push_back("'" + escaped(bases_[i].name) + "'");
        loaded.notes.push_back(fmt::format("only {} of {} bases is read, '{}': `block` NAME reads {}",
                                           base == 0 ? "the first" : "the first with volumes", bases_.size(),
                                           escaped(bases_[base].name), fmt::join(others, ", ")));
    }
    core::PatchList patch_numbers;
    for (std::size_t i = 0; i < zones_.size(); ++i) {
        // Bases are grids of their own, often in the same place: without a choice only one is read.
        const CgnsZone& zone = zones_[i];
        if (!(*chosen)[i] || (options.blocks.empty() && zone.base != base) || !is_there(zone, *step)) continue;
        if (!zone.has_points() && zones_.size() > 1) {
            loaded.notes.push_back(fmt::format("zone \"{}\" is left out: it has no coordinates", escaped(zone.name)));
            continue;
        }
        auto piece = read_zone(i, options, *step, patch_numbers, loaded);
        if (!piece) return piece.error();
        loaded.pieces.push_back(*std::move(piece));
        report_progress(static_cast<double>(i + 1) / static_cast<double>(zones_.size()));
    }
    if (loaded.pieces.empty()) return broken(path_, "no zone of it is a grid at this step");
    return loaded;
}

} // namespace

Result<Loaded> load_cgns(const std::string& path, const ReadOptions& options, Depth depth) {
    if (auto complete = check_adf_length(path); !complete) return complete.error();
    const auto names = check_hdf5_names(path, options.allow_outside);
    if (!names) return names.error();
    close_hdf5_files(); // CGNS's library opens it in a way of its own
    const auto tree = CgnsTree::open(path);
    if (!tree) return tree.error();
    auto loaded = CgnsFile(path, *tree).load(options, depth);
    for (const LeftOut& item : *names)
        if (loaded) leave_out(loaded->info, item);
    return loaded;
}

} // namespace isotet::io::confined
