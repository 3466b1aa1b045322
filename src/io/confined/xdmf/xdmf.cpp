// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// XDMF 2 and 3: the grids of a time step, one for each mesh.
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "io/amr/boxes_as_pieces.hpp"
#include "io/confined/loaders.hpp"
#include "io/confined/progress.hpp"
#include "io/confined/xdmf/xdmf_blocks.hpp"
#include "io/confined/xdmf/xdmf_fields.hpp"
#include "io/confined/xdmf/xdmf_same_cells.hpp"
#include "io/files/escape.hpp"
#include "io/pieces/block_choice.hpp"
#include "io/reader.hpp"

namespace isotet::io::confined {
namespace {

class XdmfLoader {
public:
    XdmfLoader(const XdmfFile& file, const XdmfSteps& steps, const ReadOptions& options, Depth depth)
        : file_(file), steps_(steps), options_(options), depth_(depth), fields_(file_, field_options_) {}

    Result<Loaded> load() {
        for (const LeftOut& item : steps_.left_out) leave_out(loaded_.info, item);
        for (const XdmfStep& step : steps_.steps)
            if (step.time) loaded_.info.times.push_back(*step.time);
        if (loaded_.info.times.size() != steps_.steps.size()) loaded_.info.times.clear();
        const auto step = choose_step(loaded_.info, options_);
        if (!step) return step.error();
        loaded_.step = *step;
        auto blocks = blocks_of(file_, steps_, steps_.steps[loaded_.step]);
        if (!blocks) return blocks.error();
        blocks_ = std::move(blocks->blocks);
        for (LeftOut& item : blocks->left_out) leave_out(loaded_.info, std::move(item));
        if (auto found = find_levels(); !found) return found.error();
        if (auto announced = announce_blocks(); !announced) return announced.error();
        if (auto read = read_blocks(); !read) return read.error();
        if (depth_ == Depth::arrays || !options_.step) announce_other_steps();
        if (const std::size_t domains = file_.document.domains().size(); domains > 1)
            loaded_.notes.push_back(
                fmt::format("the grids of all {} domains are read: other programs read those of the first", domains));
        return std::move(loaded_);
    }

private:
    /// Where all blocks are read, and all are evenly spaced.
    Result<void> find_levels() {
        if (blocks_.size() < 2 || !options_.blocks.empty()) return {};
        std::vector<XdmfImage> images;
        for (const XdmfBlock& block : blocks_) {
            const auto mesh = described(block.geometry, block.topology);
            if (!mesh) return mesh.error();
            if (!mesh->image) return {};
            images.push_back(*mesh->image);
        }
        levels_ = levels_of(images);
        if (levels_) field_options_ = amr::options_of_boxes(options_);
        return {};
    }
    /// The boxes of the levels as pieces of one grid.
    Result<void> join_levels() {
        amr::announce_point_values(loaded_.info);
        if (depth_ == Depth::description) return {};
        std::vector<Piece> pieces;
        for (const std::size_t i : levels_->order) pieces.push_back(std::move(loaded_.pieces[i]));
        loaded_.pieces = std::move(pieces);
        const auto joined = amr::boxes_as_pieces(levels_->hierarchy, options_, loaded_, {});
        return joined ? Result<void>{} : in_file(file_.path, joined.error());
    }

    /// Of several meshes.
    Result<void> announce_blocks() {
        if (blocks_.size() > 1 && !levels_)
            for (std::size_t i = 0; i < blocks_.size(); ++i) {
                const auto mesh = described(blocks_[i].geometry, blocks_[i].topology);
                if (!mesh) return mesh.error();
                loaded_.info.blocks.push_back({static_cast<std::int64_t>(i + 1), blocks_[i].name, "grid", mesh->cells});
            }
        auto chosen = chosen_blocks(loaded_.info.blocks, options_);
        if (!chosen) return chosen.error();
        chosen_ = blocks_.size() > 1 && !levels_ ? *std::move(chosen) : std::vector<bool>(blocks_.size(), true);
        return {};
    }
    Result<XdmfMesh> described(pugi::xml_node geometry, pugi::xml_node topology) const {
        std::vector<std::string> notes;
        return read_mesh(file_, geometry, topology, Depth::description, notes);
    }

    Result<void> read_blocks() {
        std::vector<NamedPiece> pieces;
        for (std::size_t i = 0; i < blocks_.size(); ++i) {
            const bool whole = depth_ == Depth::arrays && chosen_[i];
            auto mesh = read_block(blocks_[i], whole ? Depth::arrays : Depth::description);
            if (!mesh) return mesh.error();
            if (depth_ == Depth::description && !levels_) add(loaded_.info.least, least_of(*mesh));
            if (whole) {
                NamedPiece& piece = pieces.emplace_back(Piece(), blocks_[i].name, blocks_[i].points, mesh->edges);
                piece.piece.name = fmt::format("{} {}", file_.path, blocks_[i].name);
                piece.piece.grid = std::move(mesh->grid);
            }
            report_progress(static_cast<double>(i + 1) / static_cast<double>(blocks_.size()));
        }
        if (!levels_) take_fields_of_same_cells(pieces, loaded_.notes);
        for (NamedPiece& piece : pieces) {
            if (piece.edges) make_quadratic(piece.piece.grid, *piece.edges);
            loaded_.pieces.push_back(std::move(piece.piece));
        }
        return levels_ ? join_levels() : Result<void>{};
    }
    /// Of an image none: it is made.
    static LeastCounts least_of(const XdmfMesh& mesh) {
        if (mesh.corners == 0) return {};
        return {mesh.points, mesh.cells, mesh.corners, mesh.coordinates, true};
    }
    Result<XdmfMesh> read_block(const XdmfBlock& block, Depth depth) {
        auto mesh = read_mesh(file_, block.geometry, block.topology, depth, loaded_.notes);
        if (!mesh) return mesh.error();
        const auto time = steps_.steps[loaded_.step].time;
        for (const pugi::xml_node grid : block.grids)
            for (const XdmfField& field : fields_of(file_.document, grid, time)) {
                if (auto read = fields_.read(field, *mesh, depth, loaded_); !read) return read.error();
                announced_.insert(key_of(field));
            }
        return mesh;
    }

    /// Fields that only other steps have.
    void announce_other_steps() {
        std::vector<bool> seen(steps_.grids.size(), false);
        std::vector<std::string> missing;
        for (std::size_t s = 0; s < steps_.steps.size(); ++s)
            for (const std::uint32_t number : steps_.steps[s].grids) {
                if (seen[number]) continue;
                seen[number] = true;
                for (const XdmfField& field :
                     fields_of(file_.document, steps_.grids[number].node, steps_.steps[s].time)) {
                    if (!announced_.insert(key_of(field)).second) continue;
                    if (announce_field(steps_.grids[number].node, field) && field.association &&
                        wanted(options_, *field.association, field.name))
                        missing.push_back(fmt::format("\"{}\" (step {} has)", escaped(field.name), s));
                }
            }
        if (!missing.empty() && depth_ == Depth::arrays)
            loaded_.notes.push_back(fmt::format("step {} has no values of {}", loaded_.step, fmt::join(missing, ", ")));
    }
    /// False where it is not read in its step either.
    bool announce_field(pugi::xml_node grid, const XdmfField& field) {
        const pugi::xml_node geometry = file_.document.resolve(file_.document.child(grid, "Geometry")),
                             topology = file_.document.resolve(file_.document.child(grid, "Topology"));
        if (!geometry || !topology || (is_flat(topology) && !is_flat(blocks_.front().topology))) return false;
        auto mesh = described(geometry, topology);
        if (!mesh) return true; // an error where that step is read
        Loaded other;
        if (!fields_.read(field, *mesh, Depth::description, other)) return false;
        for (FieldInfo& found : other.info.fields) announce(loaded_.info, std::move(found));
        for (LeftOut& item : other.info.left_out) leave_out(loaded_.info, std::move(item));
        return !other.info.fields.empty();
    }
    static std::string key_of(const XdmfField& field) {
        const int place = !field.association ? 2 : *field.association == Association::point ? 0 : 1;
        return fmt::format("{} {}", place, field.name);
    }

    const XdmfFile file_;
    const XdmfSteps& steps_;
    const ReadOptions& options_;
    ReadOptions field_options_ = options_;
    std::optional<XdmfLevels> levels_; ///< where the blocks are boxes on levels
    Depth depth_;
    XdmfFieldReader fields_;
    std::vector<XdmfBlock> blocks_;
    std::vector<bool> chosen_;
    std::set<std::string> announced_;
    Loaded loaded_;
};

} // namespace

Result<Loaded> load_xdmf(const std::string& path, const ReadOptions& options, Depth depth) {
    const auto document = XdmfDocument::open(path, options.allow_outside);
    if (!document) return document.error();
    const XdmfData data(*document, options.allow_outside);
    const auto steps = sort_by_time(path, *document, data);
    if (!steps) return steps.error();
    return XdmfLoader({path, *document, data}, *steps, options, depth).load();
}

} // namespace isotet::io::confined
