// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The packed grid of a session, and what its engine keeps: brought up to date when surfaces are asked for.
#pragma once

#include <memory>
#include <optional>
#include <span>

#include <isotet/contour.hpp>

#include "base/array_slot.hpp"
#include "session/marks.hpp"
#include "session/source.hpp"

namespace isotet::session {

ExtractOptions extract_options(const ContourOptions& options, const ContourInput& input);

class PackedState {
public:
    const std::optional<PackedGrid>& packed() const { return packed_; } ///< as it was last brought up to date
    bool is_current() const { return packed_ && behind_ == ContourUpdate::nothing; }
    bool has_cells() const { return packed_ && behind_ != ContourUpdate::grid; } ///< so that little is stored again
    bool is_given() const { return is_given_; }                                  ///< ContourInput::packed
    bool has_grid() const { return grid_ != nullptr; }
    EngineGrid& grid() { return *grid_; } ///< of an engine that keeps one

    void forget();
    void forget_grid() { grid_.reset(); }

    /// Takes a packed grid and what is carried. `before`, `options`: of the session before and from now on.
    /// Errors   invalid_argument where the grid lacks what the options ask for: nothing has changed then
    Result<ContourUpdate> take_given(ContourInput& input, const ContourOptions& before, const ContourOptions& options,
                                     const Run& run);

    /// What must be stored again to extract from `next`, which has linear cells. `before`, `options` as above.
    ContourUpdate what_changed(const ContourInput& next, const ContourOptions& before, const ContourOptions& options,
                               const Run& run);

    /// The session has another input, of which this must be stored again.
    void fall_behind(ContourUpdate update);

    /// Packs, or stores what has changed since, and gives the source's cells back. An engine that fails is replaced by the
    /// CPU's in `options`, with a note, where it may be.
    Result<void> bring_up_to_date(Source& source, ContourOptions& options, const Run& run, Told& told);

    /// Lets the engine take the packed grid, if it keeps one.
    Result<void> create_grid(ContourOptions& options, const Run& run, Told& told);

    /// Extracts from the engine's grid, if there is one, one isovalue after another: what came before an error is kept.
    Result<void> extract(std::span<const double> isovalues, const Source& source, ContourOptions& options,
                         const std::shared_ptr<core::RememberingSink>& sink, const Run& run, ContourResult& result,
                         Told& told);

private:
    Result<void> pack_grid(const ContourInput& input, const ContourOptions& options, const Run& run);
    Result<void> change_points(const ContourInput& input, ContourOptions& options, const Run& run, Told& told);
    Result<void> change_field(const ContourInput& input, ContourOptions& options, const Run& run, Told& told);
    Result<void> without_engine(const Error& error, ContourOptions& options, Told& told);

    std::optional<PackedGrid> packed_; ///< of the input, but for what `behind_` says
    bool is_given_ = false;
    ContourUpdate behind_ = ContourUpdate::grid;
    std::optional<CellsMark> cells_;
    std::optional<ArrayMark> points_, field_;
    std::unique_ptr<EngineGrid> grid_;
};

} // namespace isotet::session
