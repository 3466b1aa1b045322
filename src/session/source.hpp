// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Where a session's cells come from: an input of any cells, as linear ones, and as many of them as isovalues need.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <isotet/contour.hpp>
#include <isotet/fields.hpp>
#include <isotet/linear_cells.hpp>

#include "session/curved_input.hpp"
#include "session/linear_input.hpp"

namespace isotet::session {

/// What the caller is told with the next surfaces.
struct Told {
    std::vector<std::string> notes;
    double seconds = 0; ///< spent before extraction

    void add(std::vector<std::string> more);
};

/// Of one of four kinds: all cells of the input are there; only those that a file gave for the expected isovalues; only
/// those polyhedra that they meet; curved cells, refined for the isovalues that are asked for. Copying shares the arrays.
class Source {
public:
    Source() = default;

    /// A source of the input. Where `before` has the same cells, derived points are those from before.
    ///
    /// `whole`  all cells are wanted, since a packed grid may have them
    /// Errors   as linearize(), LinearGrid::extend() and CurvedInput::take()
    static Result<Source> take(ContourInput input, const ContourOptions& options, const Source& before, bool whole,
                               const Run& run, Told& told);

    /// The source of a packed grid: what surfaces carry.
    static Source of_packed(ContourInput input);

    /// The input with linear cells. Of curved cells, before refine_for(), with those between their corners.
    const ContourInput& input() const { return is_refined() ? input_ : curved_.corners(); }
    const std::shared_ptr<const LinearGrid>& linear_grid() const; ///< null where the input is as it was given

    bool is_curved() const { return static_cast<bool>(curved_); }
    /// Not so where the input has curved cells that were not refined yet.
    bool is_refined() const { return !curved_ || curved_.grid(); }
    bool is_part() const { return met_ || input().lacks_cells(); }
    /// Cells that are known again when they are set again.
    bool may_be_packed() const { return !curved_ && !met_; }

    /// Whether no cell that is not there can be met. `options` as when it was taken.
    bool suffices(std::span<const double> isovalues, const ContourOptions& options) const;
    /// Whether there are curved cells, and they were not refined for these.
    bool is_too_coarse(std::span<const double> isovalues) const { return curved_ && !curved_.is_good_for(isovalues); }

    /// With all cells, of a part. `known`   as `before` of take()
    /// Errors   those of GridPart::whole; as take()
    Result<Source> whole(const ContourOptions& options, const Source& known, const Run& run, Told& told) const;

    /// Refines curved cells for these. What was refined before is given back first.
    /// Errors   as refine(): nothing is refined then
    Result<void> refine_for(std::span<const double> isovalues, const Run& run, Told& told);

    /// Gives the cells back, which are packed.
    void release_cells() { input_.grid = {}; }

    /// Of all cells, where that is more than those that are there have.
    std::optional<ValueRange> range() const { return met_ ? std::optional(met_.range()) : std::nullopt; }
    FieldReport field_of_curved() const { return curved_.field(); }

private:
    ContourInput input_;
    LinearInput linear_;
    MetInput met_;
    CurvedInput curved_;
};

} // namespace isotet::session
