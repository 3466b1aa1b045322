// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// VTM, VTPC and VTPD: an index of VTK XML files, in a tree of blocks with names.
#include <algorithm>
#include <iterator>
#include <optional>
#include <span>

#include <fmt/core.h>
#include <pugixml.hpp>

#include "io/files/byte_source.hpp"
#include "io/files/escape.hpp"
#include "io/files/index_file.hpp"
#include "io/files/text_scanner.hpp"
#include "io/pieces/block_choice.hpp"
#include "io/vtk_xml/columns.hpp"
#include "io/vtk_xml/document.hpp"
#include "io/vtk_xml/load.hpp"
#include "io/vtk_xml/read_vtk_xml.hpp"

namespace isotet::io {
namespace {

constexpr std::size_t max_depth = 64;

/// A file of a block that is not there.
struct MissingFile {
    Error why;
    std::size_t block = 0;
};

/// A file of a grid, or of a grid in pieces.
struct Leaf {
    std::string path;
    std::string_view type;
    std::size_t block = 0;
    std::size_t grid = 0; ///< equal for the pieces of one
};

bool is_surface(std::string_view name) { return name.ends_with(".vtp") || name.ends_with(".pvtp"); }

class IndexReader {
public:
    IndexReader(std::string path, const ReadOptions& options, const Progress& progress)
        : path_(std::move(path)), options_(options), progress_(progress) {}

    Result<void> read(std::string_view type) {
        is_one_grid_ = type == "vtkPartitionedDataSet";
        const auto source = ByteSource::open(path_);
        if (!source) return source.error();
        auto document = vtk_xml::open_document(*source, progress_);
        if (!document) return broken(path_, document.error().message);
        if (document->type != type)
            return broken(path_, fmt::format("this is a VTK file of type {}, which is not read, not {}",
                                             in_quotes(document->type), in_quotes(type)));
        if (auto walked = walk(document->primary(), {}, 0); !walked) return walked;
        if (leaves.empty() && !missing.empty()) return missing.front().why;
        if (leaves.empty())
            return broken(path_, surfaces == 0 ? "the index names no files"
                                               : fmt::format("all {} files that it names are surfaces", surfaces));
        // VTK writes FieldData behind the tree.
        for (const pugi::xml_node& parent : {document->primary().parent(), document->primary()})
            if (auto time = vtk_xml::read_time(*document, parent, progress_, said); !time) return time;
        return {};
    }

    Loaded said; ///< the time that the index states
    std::vector<Leaf> leaves;
    std::vector<MissingFile> missing;
    std::vector<BlockInfo> blocks;
    std::size_t surfaces = 0;

private:
    /// Block holds others; the files of a Piece or of Partitions are one block.
    Result<void> walk(const pugi::xml_node& parent, const std::string& parent_name, std::size_t depth) {
        if (depth > max_depth) return broken(path_, fmt::format("blocks lie in more than {} others", max_depth));
        std::size_t number = 0;
        for (const auto& element : parent.children()) {
            const std::string_view tag = element.name();
            const bool holds_blocks = tag == "Block", is_block = tag == "Piece" || tag == "Partitions";
            if (!holds_blocks && !is_block && tag != "DataSet") continue;
            ++number;
            const std::string own = element.attribute("name").as_string(fmt::format("block {}", number).c_str()),
                              name = parent_name.empty() ? own : parent_name + "/" + own;
            if (holds_blocks) {
                if (auto walked = walk(element, name, depth + 1); !walked) return walked;
                continue;
            }
            std::optional<std::size_t> block;
            if (!is_block) {
                if (auto added = add_file(element, name, block); !added) return added;
                continue;
            }
            for (const auto& file : element.children("DataSet"))
                if (auto added = add_file(file, name, block); !added) return added;
        }
        return {};
    }

    /// The first grid of a block makes it known. An element without a file stands for nothing.
    Result<void> add_file(const pugi::xml_node& element, const std::string& name, std::optional<std::size_t>& block) {
        const pugi::xml_attribute file = element.attribute("file");
        if (!file || !*file.value()) return {};
        if (is_surface(file.value())) {
            ++surfaces;
            return {};
        }
        const std::string_view type = vtk_type_of_name(file.value());
        if (type.empty() || type.starts_with("vtk"))
            return broken(path_, fmt::format("it names \"{}\", but only .vtu, .vti, .vtr, .vts and those in pieces are "
                                             "read",
                                             escaped(file.value())));
        if (!block) {
            block = blocks.size();
            blocks.push_back({static_cast<std::int64_t>(blocks.size() + 1), name, "block", 0});
        }
        const auto is_missing = [&](const Error& error) {
            if (error.code != ErrorCode::file || is_one_grid_) return false;
            missing.push_back({error, *block});
            return true;
        };
        auto path = named_file(path_, file.value(), options_.allow_outside);
        if (!path) return is_missing(path.error()) ? Result<void>() : path.error();
        if (!type.starts_with("P")) {
            leaves.push_back({std::move(*path), type, *block, grids_++});
            return {};
        }
        auto pieces = vtk_xml::files_of_pieces(*path, type, options_.allow_outside, progress_);
        if (!pieces) return is_missing(pieces.error()) ? Result<void>() : pieces.error();
        for (std::string& piece : *pieces) leaves.push_back({std::move(piece), vtk_xml::type_of_pieces(type), *block});
        return {};
    }

    std::string path_;
    const ReadOptions& options_;
    const Progress& progress_;
    std::size_t grids_ = 0;
    bool is_one_grid_ = false; ///< whose files are pieces: none may be missing
};

/// Of the blocks that are read; one that is asked for must be whole.
Result<void> tell_missing(const std::vector<MissingFile>& missing, const std::vector<bool>& chosen,
                          const ReadOptions& options, std::vector<std::string>& notes) {
    std::vector<const MissingFile*> wanted;
    for (const MissingFile& file : missing)
        if (chosen[file.block]) wanted.push_back(&file);
    if (wanted.empty()) return {};
    const Error& first = wanted.front()->why;
    if (!options.blocks.empty()) return first;
    notes.push_back(wanted.size() == 1
                        ? fmt::format("a file is left out: {}", first.message)
                        : fmt::format("{} files are left out, this one first: {}", wanted.size(), first.message));
    return {};
}

} // namespace

Result<Loaded> load_blocks(const std::string& path, std::string_view type, const ReadOptions& options, Depth depth,
                           const Progress& progress) {
    IndexReader index(path, options, progress);
    if (auto read = index.read(type); !read) return read.error();
    // The partitions of a data set are one grid without a name.
    const bool has_blocks = type != "vtkPartitionedDataSet";
    std::vector<bool> chosen(index.blocks.size(), true);
    if (has_blocks && depth == Depth::arrays) {
        auto asked = chosen_blocks(index.blocks, options);
        if (!asked) return asked.error();
        chosen = std::move(*asked);
    }
    std::vector<std::string> notes;
    if (depth == Depth::arrays)
        if (auto told = tell_missing(index.missing, chosen, options, notes); !told) return told.error();
    std::vector<vtk_xml::File> files;
    for (Leaf& leaf : index.leaves) {
        // Of the others, too, the fields and the number of cells are told.
        const Depth as_deep = chosen[leaf.block] ? depth : Depth::description;
        files.push_back({std::move(leaf.path), leaf.type, as_deep});
    }
    auto parts = vtk_xml::load_files(files, options, progress);
    if (!parts) return parts.error();
    for (std::size_t i = 0; i < parts->size(); ++i) index.blocks[index.leaves[i].block].cells += (*parts)[i].info.cells;
    for (std::size_t first = 0, end = 0; first < parts->size(); first = end) {
        while (end < parts->size() && index.leaves[end].grid == index.leaves[first].grid) ++end;
        const auto of_grid = std::span(*parts).subspan(first, end - first);
        if (auto left_out = vtk_xml::leave_out_overlaps(of_grid); !left_out) return in_file(path, left_out.error());
    }
    Loaded loaded = vtk_xml::put_together(std::move(*parts));
    std::ranges::move(notes, std::back_inserter(loaded.notes));
    if (!index.said.info.times.empty()) loaded.info.times = index.said.info.times;
    std::ranges::move(index.said.notes, std::back_inserter(loaded.notes));
    for (vtk_xml::File& file : files) loaded.info.files.push_back(std::move(file.path));
    if (has_blocks) loaded.info.blocks = std::move(index.blocks);
    if (index.surfaces > 0)
        loaded.notes.push_back(fmt::format("{} surface{} that the file names {} left out", index.surfaces,
                                           index.surfaces == 1 ? "" : "s", index.surfaces == 1 ? "is" : "are"));
    return loaded;
}

} // namespace isotet::io
