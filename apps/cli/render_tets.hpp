// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Drawing by a method that makes no surface: a store of tets on the device, and a filter that says which to draw.
#pragma once

#include <optional>
#include <vector>

#include <isotet/draw_tets.hpp>
#include <isotet/search.hpp>

#include "console.hpp"
#include "options.hpp"
#include "render_input.hpp"

namespace isotet::cli {

/// Refuses options that say how surfaces are extracted, or coloured, beside such a method, and a filter without one.
Result<void> check_method(const RenderCommand& command);

class RenderTets {
public:
    /// Uploads the store and builds the filter.
    static Result<RenderTets> load(const RenderCommand& command, const RenderInput& input, const Device& device,
                                   Console& console);

    /// The tets to draw at each isovalue; those of the last call go.
    Result<void> show(const std::vector<double>& isovalues);

    const std::vector<TetSurface>& surfaces() const noexcept { return surfaces_; }
    const TetStoreReport& report() const noexcept { return store_.report(); }

private:
    explicit RenderTets(TetStore store) : store_(std::move(store)) {}

    TetStore store_;
    std::optional<TetIndex> filter_; ///< nothing: all tets
    std::vector<TetSurface> surfaces_;
};

} // namespace isotet::cli
