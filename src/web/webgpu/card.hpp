// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The page's graphics card (WebGPU, view/web/link/webgpu.js) as an engine of sessions.
//
// Nothing in a module can wait for the card. So an extraction that the card takes fails with `cancelled` and leaves in
// Card::wanted() what is to be done; JavaScript does it, brings the surface, and makes the same call again, which finds
// it.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <isotet/engine.hpp>

#include "base/buffer.hpp"
#include "numbers/storage.hpp"
#include "packed/packed.hpp"
#include "view/json.hpp"
#include "vulkan/engine/page_plan.hpp"

namespace isotet::web {

class Card {
public:
    /// `binding_bytes`   of a buffer at most;   `groups_per_axis`   of a dispatch
    void turn_on(std::uint64_t binding_bytes, std::uint32_t groups_per_axis);
    /// The processor does all from now on.
    void turn_off();

    /// As EngineGrid::extract() of one isovalue. Errors   cancelled: see above
    Result<Extraction> extract(const PackedGrid& packed, double isovalue, const ExtractOptions& options);

    /// The rule, in one place: whether the card does this. All else is for the processor.
    bool takes(const PackedGrid& packed, std::size_t isovalues, const ExtractOptions& options) const;

    /// Whether no call before this one extracted from the grid: one surface is not worth bringing it to the card.
    bool is_new(const PackedGrid& packed);

    /// What the card is to do, once; nothing: nothing.
    std::optional<view::Json> wanted();
    /// Memory for its answer: {"positions": address, "triangles": address}; null where there is none.
    view::Json room_for(std::uint32_t vertices, std::uint32_t triangles, std::uint32_t tied_points,
                        std::uint32_t selected_clusters);

    /// The processor makes what is wanted, and all other surfaces of the grid: this one is too large.
    void leave();

    /// Extracts from the grid that was extracted from last, at a part of its range: what there is to tell of the
    /// surface; null where the card cannot have the grid, or something is wanted first.
    view::Json measure(double part, bool by_card);

    /// While one is there, who calls can wait for the card. Surfaces are kept until a call needs nothing more.
    class Asking {
    public:
        explicit Asking(Card& card) : card_(card) {
            card_.may_ask_ = true;
            ++card_.calls_;
        }
        ~Asking();
        Asking(const Asking&) = delete;
        Asking& operator=(const Asking&) = delete;

    private:
        Card& card_;
    };

private:
    struct Made {
        const core::Packed* packed;
        core::StoredIsovalue<float> isovalue;
        Ties ties;
        Array positions, triangles;
        std::uint64_t tied_points, selected_clusters;
    };
    /// Where things of a grid lie, in words.
    struct Places {
        std::uint32_t counts, segments, blocks, starts, selected, emitted, masks, all; ///< of the state
        std::uint32_t clusters_without_data;                                           ///< in the tables
    };
    bool can_have(const std::shared_ptr<const core::Packed>& packed);
    bool plan(const core::Packed& packed);
    void fill(const core::Packed& packed);
    void release_upload();
    std::vector<std::uint32_t> push_words() const;

    bool on_ = false, may_ask_ = false;
    std::uint64_t binding_bytes_ = 0;
    std::uint32_t groups_per_axis_ = 0;
    std::weak_ptr<const core::Packed> seen_, there_,
        too_large_;                            ///< of the last call; that the card has; that it cannot have
    std::uint64_t calls_ = 0, seen_first_ = 0; ///< number of the call that had seen_ first
    std::uint32_t number_ = 0;                 ///< of the grid there
    vulkan::PlannedPage page_;                 ///< its only one
    Places places_{};
    core::Buffer<std::uint32_t> page_words_; ///< until it is there
    std::vector<vulkan::layout::Cluster> clusters_;
    std::vector<std::uint32_t> tables_;

    std::shared_ptr<const core::Packed> asked_of_; ///< null: nothing is asked for
    core::StoredIsovalue<float> asked_{0};
    Ties asked_ties_ = Ties::merge;
    bool is_handed_out_ = false; ///< what is asked for, by wanted()
    std::vector<Made> made_;
};

Card& card();
/// The card where it takes what is asked for, else the CPU engine.
std::shared_ptr<const Engine> card_engine();

/// Tells JavaScript what a call waits for, which is made again then. False: it waits for nothing.
bool say_wanted();

/// The kernels, each a text that WebGPU compiles: {"select": ..., "count": ..., "scan": ..., "emit": ...}.
view::Json card_kernels();

/// Surfaces of a small grid of all kinds of cells by both engines, as Card::extract() asks for them.
/// Errors   cancelled: the card is to do something first; no_device: it gives another surface
Result<void> test_card();

} // namespace isotet::web
