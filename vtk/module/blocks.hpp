// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The unstructured grids of a data set, contoured together: those of all ranks have one frame, so that their surfaces fit.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "block.hpp"
#include "ranks.hpp"

namespace isotet_vtk {

/// A grid to contour and where its surface goes.
struct BlockTask {
    unsigned int index = 0; ///< of the grid in its data set: the same one over time
    vtkUnstructuredGrid* grid = nullptr;
    vtkDataArray* scalars = nullptr;
    vtkPolyData* out = nullptr;
};

/// What was found when a rank looked for its tasks.
struct Looked {
    std::string error;
    std::string missing; ///< of blocks without the array: the error if no block of any rank has it
    bool found = false;  ///< a block has it
    bool is_composite = false;
};

class Blocks {
public:
    /// Contours all tasks of this rank. Collective: each rank of `ranks` calls it once an execution, with no task or after
    /// an error, too.
    ///
    /// Guarantees  the surfaces of all ranks are together those of the whole, if points have global ids; else vertices are
    /// Returns     empty, or the error, of another rank perhaps: then no rank has a surface
    std::string contour(const std::vector<BlockTask>& tasks, const Wishes& wishes, const Ranks& ranks,
                        const isotet::Run& run, const Looked& looked);

    /// Sentences for the user about the last contour().
    const std::vector<std::string>& notes() const { return notes_; }

    /// The cell types of a block that isotet does not contour, VTK's numbers.
    std::vector<std::uint8_t> other_types(unsigned int index) const;

    /// The most that was to be done for a block in the last contour(); whether all extract from packed grids.
    isotet::ContourUpdate update() const { return update_; }
    bool all_packed() const;
    std::uint64_t packed_bytes() const;
    double extract_seconds() const;
    double field_bound() const; ///< of curved cells that were refined; 0 where there are none

private:
    std::string take(const std::vector<BlockTask>& tasks, const Wishes& wishes);
    std::string agree(const std::vector<BlockTask>& tasks, const Ranks& ranks, const isotet::Run& run,
                      std::string error, const Looked& looked);
    std::string make_frame(const Ranks& ranks, const isotet::Run& run);
    isotet::Result<isotet::Survey> survey(const isotet::Run& run);
    std::string why_pieces_have_walls(const Ranks& ranks, const Looked& looked);
    std::string extract(const std::vector<BlockTask>& tasks, const isotet::Run& run);

    std::map<unsigned int, Block> blocks_;
    std::optional<isotet::Frame> frame_;
    bool with_numbers_ = false;
    bool is_framed_ = false; ///< frame_ is that of the blocks as they are
    isotet::ContourUpdate update_ = isotet::ContourUpdate::nothing;
    std::vector<std::string> notes_;
};

} // namespace isotet_vtk
