// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Surfaces in files, measured and judged: what `isotet check` does.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <isotet/check.hpp>
#include <isotet/contour.hpp>
#include <isotet/isovalues.hpp>
#include <isotet/jobs/field_choice.hpp>
#include <isotet/jobs/grid_source.hpp>

namespace isotet::jobs {

struct CheckJob {
    std::string surface;
    std::vector<std::string> more;          ///< other pieces of the surface
    std::vector<std::string> other_outputs; ///< of the caller: no input may be one
    std::string format;
    bool closed = false;
    bool strict = false;
    GridOptions grid; ///< that the surface was extracted from; `file` is empty without one
    FieldChoice field;
    /// As the surface was made, of which split cells count; and curved cells are refined as they were for it, so that its points
    /// are derived again.
    ContourOptions contour{.refine = RefineOptions{}};
    bool refine_averaged = false; ///< as of ExtractJob
    /// All that were extracted together; empty: those of the cell field `isovalue` of a file with several, else the cells
    /// are taken at their nodes.
    std::vector<double> isovalues;
    std::vector<IsovalueShare> shares = {}; ///< more of them
};

struct CheckedFiles {
    SurfaceReport report;
    std::string format; ///< of the first file
    bool passed = false;
};

/// Errors   invalid_argument: a grid is given, but the surface lacks edge_ends, or names do not fit; as of reading
Result<CheckedFiles> check_files(const CheckJob& job, Caller& caller);

} // namespace isotet::jobs
