// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What a session is given where curved cells are refined for each isovalue.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <isotet/contour.hpp>
#include <isotet/linear_cells.hpp>

namespace isotet::session {

/// Sentences for the user: what was refined, its bound, and what was left out.
std::vector<std::string> notes_on(const RefinementReport& report);

/// An input with curved cells, and what it was refined to last. Copying shares both. Empty: there is none.
class CurvedInput {
public:
    explicit operator bool() const { return user_.has_value(); }

    /// Errors   invalid_argument when fields do not fit the grid, or the options have a frame; invalid_data as
    ///          CellReader::open()
    Result<void> take(ContourInput input, const ContourOptions& options);

    /// The input with linear cells between the corners of curved ones: for a look at the field, not for surfaces.
    const ContourInput& corners() const { return corners_; }

    /// The last refinement is for these, among others.
    bool is_good_for(std::span<const double> isovalues) const;

    /// The input on a grid refined for these, and for those of the options if they are among them.
    /// Errors   as refine()
    Result<ContourInput> refine(std::span<const double> isovalues, const Run& run);

    /// Null before refine().
    const std::shared_ptr<const LinearGrid>& grid() const { return refined_; }

    /// After refine(): notes_on(), and which bounds are not those of VTK's cells.
    std::vector<std::string> notes() const;

    /// The range of the field at the nodes of all cells that are contoured.
    FieldReport field() const;

private:
    std::optional<ContourInput> user_;
    ContourInput corners_;
    RefineOptions options_;
    std::uint64_t own_pyramids_ = 0; ///< of 13 and 19 nodes, whose functions are not VTK's
    std::shared_ptr<const LinearGrid> refined_;
};

} // namespace isotet::session
