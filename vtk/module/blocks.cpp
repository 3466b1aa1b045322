// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "blocks.hpp"

#include <algorithm>
#include <utility>

#include <isotet/memory.hpp>

#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>

namespace isotet_vtk {

namespace {

/// Marks surveys of one rank that have nothing in common: no frame can be made with it.
isotet::Survey impossible_survey() {
    isotet::Survey survey;
    survey.field_count = isotet::Survey::max_fields + 1;
    return survey;
}

isotet::Survey contoured_field_only(isotet::Survey survey) {
    survey.field_count = std::min(survey.field_count, 1U);
    std::fill(survey.fields.begin() + 1, survey.fields.end(), isotet::FieldSurvey{});
    return survey;
}

/// As merge(); where carried fields are not the same in all, of the contoured one alone.
isotet::Result<isotet::Survey> merge_common(const std::vector<isotet::Survey>& surveys) {
    isotet::Survey all;
    for (const isotet::Survey& survey : surveys) {
        isotet::Result<isotet::Survey> both = isotet::merge(all, survey);
        if (!both && survey.field_count <= isotet::Survey::max_fields)
            both = isotet::merge(contoured_field_only(all), contoured_field_only(survey));
        if (!both) return both;
        all = *both;
    }
    return all;
}

} // namespace

/// Blocks that are gone give up what they keep.
std::string Blocks::take(const std::vector<BlockTask>& tasks, const Wishes& wishes) {
    std::erase_if(blocks_, [&](const auto& block) {
        return std::ranges::none_of(tasks, [&](const BlockTask& task) { return task.index == block.first; });
    });
    std::string error;
    for (const BlockTask& task : tasks)
        if (auto ok = blocks_[task.index].take(task.grid, task.scalars, wishes); !ok && error.empty())
            error = ok.error().message;
    return error;
}

isotet::Result<isotet::Survey> Blocks::survey(const isotet::Run& run) {
    std::vector<isotet::Survey> surveys;
    for (auto& [index, block] : blocks_) {
        if (!block.has_contoured()) continue;
        const auto one = block.survey(run);
        if (!one) return one;
        surveys.push_back(*one);
    }
    const auto all = merge_common(surveys);
    return all ? *all : impossible_survey();
}

/// One gather. Every rank gets the same surveys, and so the same frame or the same error.
std::string Blocks::make_frame(const Ranks& ranks, const isotet::Run& run) {
    std::string error;
    isotet::Survey mine;
    if (const auto own = survey(run)) mine = *own;
    else error = own.error().message;
    const std::vector<isotet::Survey> surveys = ranks.gather(mine);
    error = ranks.first_error(error);
    if (!error.empty()) return error;
    frame_.reset();
    is_framed_ = true;
    const auto whole = merge_common(surveys);
    if (whole && whole->field_count == 0) return {}; // nowhere is a cell
    if (whole && whole->field_count <= isotet::Survey::max_fields)
        if (const auto frame = isotet::make_frame({{*whole}})) frame_ = *frame;
    if (!frame_)
        notes_.push_back(
            "surfaces of blocks may not fit where these meet: their points or scalars are not of one type");
    return {};
}

/// The first collective call: whether all may go on, and whether the frame must be made again.
std::string Blocks::agree(const std::vector<BlockTask>& tasks, const Ranks& ranks, const isotet::Run& run,
                          std::string error, const Looked& looked) {
    Ranks::Flags mine{.failed = !error.empty(),
                      .changed = !is_framed_,
                      .renumbered = false,
                      .no_global_ids = false,
                      .too_many = tasks.size() > 1,
                      .missing = !looked.missing.empty(),
                      .found = looked.found};
    for (const auto& [index, block] : blocks_) {
        mine.changed |= block.is_new();
        mine.renumbered |= block.is_renumbered();
        mine.no_global_ids |= block.has_contoured() && !block.has_global_ids();
    }
    const Ranks::Flags all = ranks.any(mine);
    if (!all.failed && all.missing && !all.found) {
        is_framed_ = false;
        return ranks.first_error(looked.missing);
    }
    if (ranks.count() < 2 && !all.too_many) { // a grid of its own
        frame_.reset();
        is_framed_ = with_numbers_ = false;
        return error;
    }
    with_numbers_ = !all.no_global_ids;
    if (all.failed) {
        is_framed_ = false;
        return ranks.first_error(error);
    }
    if (!all.changed) return {};
    is_framed_ = false;
    return make_frame(ranks, run);
}

/// Solids of pieces without ghost cells end where pieces meet. Blocks may be wholes: of them it is only noted.
std::string Blocks::why_pieces_have_walls(const Ranks& ranks, const Looked& looked) {
    int with_cells = 0, with_ghosts = 0;
    for (const auto& [index, block] : blocks_) {
        with_cells |= block.has_contoured();
        with_ghosts |= block.cells().has_cells_of_other_pieces();
    }
    if (ranks.sum(with_cells) < 2 || ranks.sum(with_ghosts) > 0) return {};
    const std::string need =
        "ghost cells, of which solids of pieces need one layer: vtkGhostCellsGenerator makes them, in "
        "ParaView Ghost Cells";
    if (!looked.is_composite) return "the grid lies in pieces on several ranks, without " + need;
    notes_.push_back("blocks on several ranks have no " + need);
    return {};
}

std::string Blocks::extract(const std::vector<BlockTask>& tasks, const isotet::Run& run) {
    update_ = isotet::ContourUpdate::nothing;
    for (const BlockTask& task : tasks) {
        Block& block = blocks_[task.index];
        if (!block.has_contoured()) continue;
        if (auto ok = block.extract(frame_, with_numbers_, run, task.out); !ok) return ok.error().message;
        update_ = std::max(update_, block.update());
        notes_.insert(notes_.end(), block.notes().begin(), block.notes().end());
    }
    return {};
}

std::string Blocks::contour(const std::vector<BlockTask>& tasks, const Wishes& wishes, const Ranks& ranks,
                            const isotet::Run& run, const Looked& looked) {
    notes_.clear();
    Wishes possible = wishes;
    if (tasks.size() > 1 || ranks.count() > 1) possible.tolerance = 0; // pieces cannot be refined
    std::string error = looked.error.empty() ? take(tasks, possible) : looked.error;
    error = agree(tasks, ranks, run, std::move(error), looked);
    if (error.empty() && wishes.solid != SolidWish::none) error = why_pieces_have_walls(ranks, looked);
    if (error.empty()) error = ranks.first_error(extract(tasks, run));
    if (!error.empty())
        for (const BlockTask& task : tasks) task.out->Initialize();
    for (auto& [index, block] : blocks_) block.release();
    if (update_ == isotet::ContourUpdate::grid) isotet::release_memory(); // packing leaves more than surfaces need
    return error;
}

std::vector<std::uint8_t> Blocks::other_types(unsigned int index) const {
    const auto found = blocks_.find(index);
    return found == blocks_.end() ? std::vector<std::uint8_t>() : found->second.cells().other_types();
}

bool Blocks::all_packed() const {
    return !blocks_.empty() && std::ranges::all_of(blocks_, [](const auto& block) {
        return block.second.method() == isotet::Method::clusters;
    });
}

std::uint64_t Blocks::packed_bytes() const {
    std::uint64_t bytes = 0;
    for (const auto& [index, block] : blocks_) bytes += block.packed_bytes();
    return bytes;
}

double Blocks::field_bound() const {
    double bound = 0;
    for (const auto& [index, block] : blocks_) bound = std::max(bound, block.field_bound());
    return bound;
}

double Blocks::extract_seconds() const {
    double seconds = 0;
    for (const auto& [index, block] : blocks_) seconds += block.extract_seconds();
    return seconds;
}

} // namespace isotet_vtk
