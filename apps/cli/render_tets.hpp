// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Drawing by a method that makes no surface: a store of tets on the device, and a search index that finds
// those to draw.
#pragma once

#include <optional>
#include <vector>

#include <isotet/draw_tets.hpp>
#include <isotet/search.hpp>

#include "console.hpp"
#include "options.hpp"

namespace isotet::cli {

/// Refuses options that say how surfaces are extracted, or coloured, beside such a method, and a search index without one.
Result<void> check_method(const RenderCommand& command);

class RenderTets {
public:
    /// Uploads the store and builds the search index.
    /// `packed`   in single precision, with gradients for the methods that shade by them
    static Result<RenderTets> load(const RenderCommand& command, const PackedGrid& packed, const Device& device,
                                   Console& console);

    /// The tets to draw at each isovalue; those of the last call go.
    Result<void> show(const std::vector<double>& isovalues);

    const std::vector<TetSurface>& surfaces() const noexcept { return surfaces_; }
    const TetStoreReport& report() const noexcept { return store_.report(); }

private:
    explicit RenderTets(TetStore store) : store_(std::move(store)) {}

    TetStore store_;
    std::optional<TetIndex> index_; ///< nothing: all tets
    std::vector<TetSurface> surfaces_;
};

} // namespace isotet::cli
