// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Exodus II: the blocks of a file share their nodes; the files of a parallel run ("name.4.0" to "name.4.3") are joined
// by the global numbers of their nodes.
#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>

#include <fmt/format.h>

#include "io/reader.hpp"
#include "io/pieces/block_choice.hpp"
#include "io/pieces/survey_unread.hpp"
#include "io/files/escape.hpp"
#include "io/files/text_scanner.hpp"
#include "io/confined/exodus/exodus_cells.hpp"
#include "io/confined/exodus/exodus_file.hpp"
#include "io/confined/exodus/exodus_parts.hpp"
#include "io/confined/exodus/exodus_sides.hpp"
#include "io/confined/hdf5/hdf5_walk.hpp"
#include "io/confined/loaders.hpp"
#include "io/confined/progress.hpp"

namespace isotet::io::confined {
namespace {

const char* kind_of_variable(Association association) {
    return association == Association::point ? "point field" : "cell field";
}

constexpr std::size_t most_open = 200; ///< parts, of up to two files each: a process may have 1024

/// A part, and the data sets that HDF5 cannot open.
struct OpenPart {
    ExodusFile file;
    std::vector<LeftOut> broken;

    /// Why a variable cannot be read, for some step or block; nothing: as far as is known, it can.
    std::optional<std::string> why_without(Association association, std::size_t variable) const {
        const std::string own = association == Association::point ? fmt::format("vals_nod_var{}", variable + 1)
                                                                  : fmt::format("vals_elem_var{}eb", variable + 1);
        for (const LeftOut& item : broken)
            if (association == Association::point ? item.name == own || item.name == "vals_nod_var"
                                                  : item.name.starts_with(own))
                return item.reason;
        return std::nullopt;
    }
};

FileInfo describe(const OpenPart& part) {
    const ExodusFile& file = part.file;
    FileInfo info;
    info.times = file.times();
    const auto take = [&](Association association, const std::vector<std::string>& names) {
        for (std::size_t i = 0; i < names.size(); ++i)
            if (auto reason = part.why_without(association, i))
                leave_out(info, {kind_of_variable(association), names[i], *std::move(reason)});
            else announce(info, {names[i], association, file.type(), 1});
    };
    take(Association::point, file.point_variables());
    take(Association::cell, file.cell_variables());
    for (const LeftOut& item : part.broken)
        if (!item.name.starts_with("vals_nod_var") && !item.name.starts_with("vals_elem_var")) leave_out(info, item);
    return info;
}

/// A variable that cannot be read is left out.
Result<void> take_variable(Association association, const std::string& name, Result<Array> values, FileInfo& info,
                           std::vector<Field>& fields) {
    if (values) fields.push_back({name, *std::move(values)});
    else if (values.error().code != ErrorCode::invalid_data) return values.error();
    else leave_out(info, {kind_of_variable(association), name, values.error().message});
    return {};
}

void note_unwritten(Association association, const std::string& name, const ExodusFile::Gaps& gaps, std::uint64_t all,
                    Loaded& loaded) {
    if (gaps.values > 0)
        loaded.notes.push_back(fmt::format("{} \"{}\" has {} values of {} that were never written: NaN there",
                                           kind_of_variable(association), escaped(name), gaps.values, all));
}

/// A variable that is left in the file.
class ExodusValues final : public FieldSource {
public:
    ExodusValues(std::shared_ptr<const OpenPart> part, ExodusFile::CellVariable variable)
        : part_(std::move(part)), variable_(std::move(variable)) {}

    Result<Array> read(const std::vector<std::uint64_t>& cells) const override {
        return part_->file.values_of(variable_, cells);
    }
    Result<Array> read() const override { return part_->file.values_of(variable_); }

private:
    std::shared_ptr<const OpenPart> part_;
    ExodusFile::CellVariable variable_;
};

/// A cell field, with its gaps: left in the file where the cells of the piece are.
Result<ExodusFile::Gaps> read_cell_field(const std::shared_ptr<OpenPart>& opened, std::size_t variable,
                                         const ReadOptions& options, Loaded& loaded, Piece& piece) {
    ExodusFile& file = opened->file;
    const std::string& name = file.cell_variables()[variable];
    ExodusFile::Gaps gaps;
    if (piece.unread && !are_counted(options)) {
        auto found = file.find_cell_variable(variable, loaded.step);
        auto counted = file.gaps_of(found);
        if (counted) {
            piece.unread_fields.push_back(
                {name, file.type(), 1, std::make_shared<const ExodusValues>(opened, std::move(found))});
            return counted;
        }
        if (counted.error().code != ErrorCode::invalid_data) return counted;
        leave_out(loaded.info, {kind_of_variable(Association::cell), name, counted.error().message});
        return gaps;
    }
    auto values = file.cell_variable(variable, loaded.step, gaps);
    auto taken = take_variable(Association::cell, name, std::move(values), loaded.info, piece.grid.cell_fields);
    return taken ? Result<ExodusFile::Gaps>(gaps) : taken.error();
}

Result<void> read_fields(const std::shared_ptr<OpenPart>& opened, const ReadOptions& options, Loaded& loaded,
                         Piece& piece) {
    OpenPart& part = *opened;
    ExodusFile& file = part.file;
    Grid& grid = piece.grid;
    const auto is_read = [&](Association association, const std::string& name, std::size_t variable) {
        return wanted(options, association, name) && !part.why_without(association, variable);
    };
    if (file.times().empty()) return {};
    for (std::size_t i = 0; i < file.point_variables().size(); ++i) {
        const std::string& name = file.point_variables()[i];
        if (!is_read(Association::point, name, i)) continue;
        ExodusFile::Gaps gaps;
        auto values = file.point_variable(i, loaded.step, gaps);
        note_unwritten(Association::point, name, gaps, file.points(), loaded);
        auto taken = take_variable(Association::point, name, std::move(values), loaded.info, grid.point_fields);
        if (!taken) return taken;
    }
    std::map<std::size_t, std::vector<std::string>> undefined; // by the blocks that lack them
    for (std::size_t i = 0; i < file.cell_variables().size(); ++i) {
        const std::string& name = file.cell_variables()[i];
        if (!is_read(Association::cell, name, i)) continue;
        const auto gaps = read_cell_field(opened, i, options, loaded, piece);
        if (!gaps) return gaps.error();
        note_unwritten(Association::cell, name, *gaps, file.cells(), loaded);
        if (gaps->blocks > 0) undefined[gaps->blocks].push_back(fmt::format("\"{}\"", escaped(name)));
    }
    for (const auto& [blocks, names] : undefined)
        loaded.notes.push_back(fmt::format("cell field{} {} {} not defined in {} of {} element blocks: NaN there",
                                           names.size() == 1 ? "" : "s", fmt::join(names, ", "),
                                           names.size() == 1 ? "is" : "are", blocks, file.blocks().size()));
    return {};
}

/// Those that are broken are left out.
Result<void> read_side_sets(const ExodusFile& file, const ReadOptions& options, Loaded& loaded, Grid& grid) {
    if (!options.patches) return {};
    auto patches = exodus_side_sets(file, grid);
    if (patches) grid.patches = *std::move(patches);
    else if (patches.error().code != ErrorCode::invalid_data) return patches.error();
    else leave_out(loaded.info, {"patch", "side sets", patches.error().message});
    return {};
}

/// Elements of which not all nodes are read, and those of which nothing is.
void say_what_is_read(const ExodusFile& file, Loaded& loaded) {
    std::map<std::string, std::uint64_t> shorter;
    for (const auto& block : file.blocks()) {
        const ExodusElement element = exodus_element(block.topology, block.corners);
        if (block.cells == 0 || element.nodes == block.corners) continue;
        if (element.type == 0)
            leave_out(loaded.info, {"block", block.name.empty() ? std::to_string(block.id) : block.name,
                                    block.topology.starts_with("BEX")
                                        ? fmt::format("its elements are {} (Bezier extraction), which is not read",
                                                      escaped(block.topology))
                                        : fmt::format("its elements are {} with {} nodes, which are not read",
                                                      escaped(block.topology), block.corners)});
        else shorter[fmt::format("{} of {} nodes", name_of_cell_type(element.type), block.corners)] += block.cells;
    }
    std::vector<std::string> parts;
    for (const auto& [kind, cells] : shorter) parts.push_back(fmt::format("{} {}", cells, kind));
    if (!parts.empty())
        loaded.notes.push_back(fmt::format("cells were read by their corners and the nodes on edges, if there are any, "
                                           "without nodes in faces and in the middle: {}",
                                           fmt::join(parts, ", ")));
}

/// Blocks, then sets.
std::vector<BlockInfo> blocks_of(const ExodusFile& file) {
    std::vector<BlockInfo> blocks;
    for (const ExodusFile::Block& block : file.blocks())
        blocks.push_back({block.id, block.name, "element block", block.cells});
    for (const ExodusFile::Set& set : file.sets()) blocks.push_back({set.id, set.name, "element set", set.cells});
    return blocks;
}

/// Opens a part, once it is known to be whole.
Result<std::shared_ptr<OpenPart>> open_part(const std::string& part, const ReadOptions& options) {
    auto broken = check_hdf5_names(part, options.allow_outside);
    if (!broken) return broken.error();
    auto file = ExodusFile::open(part);
    if (!file) return file.error();
    return std::make_shared<OpenPart>(OpenPart{*std::move(file), *std::move(broken)});
}

/// How many steps files have in common, from the first one on: of those with as many all, else those of equal times.
std::size_t common_steps(const std::vector<double>& a, const std::vector<double>& b) {
    if (a.size() == b.size()) return a.size();
    return static_cast<std::size_t>(std::ranges::mismatch(a, b).in1 - a.begin());
}

LeastCounts least_of(const ExodusFile& file) {
    LeastCounts least{file.points(), file.cells(), 0, file.type()};
    for (const ExodusFile::Block& block : file.blocks())
        least.corners += block.cells * exodus_element(block.topology, block.corners).nodes;
    return least;
}

/// What all parts hold. `opened` gets them, unless they are too many.
Result<FileInfo> describe_parts(const std::vector<std::string>& parts, const ReadOptions& options,
                                std::vector<std::string>& notes, std::vector<std::shared_ptr<OpenPart>>& opened) {
    FileInfo all;
    std::size_t fewest = 0, most = 0;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        auto file = open_part(parts[i], options);
        if (!file) return file.error();
        if (parts.size() <= most_open) opened.push_back(*file);
        FileInfo info = describe(**file);
        if (const std::uint64_t cut = (*file)->file.steps_cut_off(); cut > 0)
            notes.push_back(fmt::format("{}the last {}of {} time steps {} cut short and left out",
                                        parts.size() > 1 ? escaped(parts[i]) + ": " : "",
                                        cut > 1 ? fmt::format("{} ", cut) : "", info.times.size() + cut,
                                        cut > 1 ? "are" : "is"));
        const std::size_t steps = info.times.size();
        if (i == 0) {
            all.times = info.times;
            fewest = most = steps;
        }
        const std::size_t common = common_steps(all.times, info.times);
        if (common == 0 && all.times.size() != steps)
            return broken(parts[i], fmt::format("this part has {} time steps and the parts before it {}, of which none "
                                                "have the same time",
                                                steps, all.times.size()));
        all.times.resize(common);
        fewest = std::min(fewest, steps);
        most = std::max(most, steps);
        for (FieldInfo& field : info.fields) announce(all, std::move(field));
        for (LeftOut& item : info.left_out) leave_out(all, std::move(item));
        add(all.least, least_of((*file)->file));
        for (const BlockInfo& block : blocks_of((*file)->file)) announce_block(all, block);
    }
    if (fewest != most)
        notes.push_back(fmt::format("its parts have {} to {} time steps: those that all have are read, the first {}",
                                    fewest, most, all.times.size()));
    return all;
}

/// Which blocks and sets of one part are asked for, in the order of blocks_of().
std::vector<bool> chosen_here(const ExodusFile& file, const FileInfo& info, const std::vector<bool>& chosen) {
    std::vector<bool> here;
    for (const BlockInfo& block : blocks_of(file)) {
        const auto known = std::ranges::find_if(info.blocks, [&](const BlockInfo& other) {
            return other.number == block.number && other.name == block.name && other.kind == block.kind;
        });
        here.push_back(chosen[static_cast<std::size_t>(known - info.blocks.begin())]);
    }
    return here;
}

/// Marks the cells of all blocks that are in none of the chosen blocks and sets.
Result<void> leave_out_others(const ExodusFile& file, const std::vector<bool>& chosen, Piece& piece) {
    piece.left_out.clear();
    for (std::size_t i = 0; i < file.blocks().size(); ++i)
        piece.left_out.insert(piece.left_out.end(), file.blocks()[i].cells, chosen[i] ? 0 : 1);
    for (std::size_t i = 0; i < file.sets().size(); ++i) {
        if (!chosen[file.blocks().size() + i]) continue;
        const auto cells = file.cells_of(file.sets()[i]);
        if (!cells) return cells.error();
        for (const std::int64_t cell : *cells) piece.left_out[static_cast<std::size_t>(cell)] = 0;
    }
    return {};
}

/// Whether active cells may do.
bool may_be_left(const ReadOptions& options) {
    return options.active_cells && options.blocks.empty() && !options.patches;
}

struct PartRead {
    std::string path;
    bool with_ids = false;
    bool stays_open = false; ///< may do so, until its cells are read
};

Result<Piece> read_piece(const std::shared_ptr<OpenPart>& opened, const PartRead& part, const ReadOptions& options,
                         Loaded& loaded) {
    ExodusFile& file = opened->file;
    Piece piece;
    piece.name = part.path;
    auto points = file.coordinates();
    if (!points) return points.error();
    piece.grid.points = std::move(*points);
    if (part.stays_open && may_be_left(options)) piece.unread = unread_exodus_cells({opened, &file}, part.path);
    if (!piece.unread) {
        auto cells = read_exodus_cells(file, part.path);
        if (!cells) return cells.error();
        piece.grid.cells = std::move(*cells);
    }
    say_what_is_read(file, loaded);
    if (auto read = read_side_sets(file, options, loaded, piece.grid); !read) return read.error();
    if (auto read = read_fields(opened, options, loaded, piece); !read) return read.error();
    if (!part.with_ids) return piece;
    auto point_ids = file.point_ids();
    if (!point_ids) return point_ids.error();
    auto cell_ids = file.cell_ids();
    if (!cell_ids) return cell_ids.error();
    piece.point_ids = std::move(*point_ids);
    piece.cell_ids = std::move(*cell_ids);
    return piece;
}

Result<Piece> read_chosen(const std::shared_ptr<OpenPart>& opened, const PartRead& part, const ReadOptions& options,
                          const std::vector<bool>& chosen, Loaded& loaded) {
    ExodusFile& file = opened->file;
    const std::vector<bool> here = chosen_here(file, loaded.info, chosen);
    const auto sets = here.begin() + static_cast<std::ptrdiff_t>(file.blocks().size());
    const bool all_blocks = std::find(sets, here.end(), true) != here.end();
    if (!all_blocks) file.choose({here.begin(), sets});
    auto piece = read_piece(opened, part, options, loaded);
    if (!piece) return piece;
    if (all_blocks) {
        if (auto left_out = leave_out_others(file, here, *piece); !left_out) return left_out.error();
        if (auto dropped = drop_left_out_cells(*piece); !dropped) return dropped.error();
    } else {
        drop_unused_points(*piece);
    }
    return piece;
}

void note_missing_parts(const std::vector<std::string>& missing, std::vector<std::string>& notes) {
    if (missing.empty()) return;
    const std::string first = in_quotes(std::filesystem::path(missing.front()).filename().string());
    notes.push_back(fmt::format(
        "by its name the file is one of {} parts, but {} not there: only its own cells are read", missing.size() + 1,
        missing.size() == 1 ? first + " is" : fmt::format("{} and {} more are", first, missing.size() - 1)));
}

} // namespace

Result<Loaded> load_exodus(const std::string& path, const ReadOptions& options, Depth depth) {
    const auto found = exodus_parts(path);
    if (!found) return found.error();
    const std::vector<std::string>& parts = found->files;
    Loaded loaded;
    note_missing_parts(found->missing, loaded.notes);
    std::vector<std::shared_ptr<OpenPart>> all_opened;
    auto info = describe_parts(parts, options, loaded.notes, all_opened);
    if (!info) return info.error();
    loaded.info = std::move(*info);
    const auto chosen = chosen_blocks(loaded.info.blocks, options);
    if (!chosen) return chosen.error();
    if (depth == Depth::description) return loaded;
    const auto step = choose_step(loaded.info, options);
    if (!step) return step.error();
    loaded.step = *step;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const PartRead part{parts[i], parts.size() > 1, parts.size() <= most_open};
        auto opened = part.stays_open ? Result(std::move(all_opened[i])) : open_part(part.path, options);
        if (!opened) return opened.error();
        auto piece = options.blocks.empty() ? read_piece(*opened, part, options, loaded)
                                            : read_chosen(*opened, part, options, *chosen, loaded);
        if (!piece) return piece.error();
        loaded.pieces.push_back(std::move(*piece));
        report_progress(static_cast<double>(i + 1) / static_cast<double>(parts.size()));
    }
    return loaded;
}

} // namespace isotet::io::confined
