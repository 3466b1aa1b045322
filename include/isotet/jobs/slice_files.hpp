// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// From a grid file to files of cuts through it: what `isotet slice` does.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <isotet/jobs/extract_files.hpp>
#include <isotet/slice.hpp>

namespace isotet::jobs {

/// The options of extract_files() for the surfaces, but for field, isovalues, levels and snap: `shape` is in place of these.
/// Shares are of the grid's part before the plane or inside the shape.
struct SliceJob : ExtractJob {
    std::optional<SliceShape> shape;
    std::vector<double> at; ///< offsets of planes, radii; {value} in OUT. Empty, as `shares`: `count`, else where `shape` is
    std::uint64_t count = 0; ///< so many planes along the normal: min + k (max - min) / (count + 1), k = 1..count, of the
                             ///< grid's extent at each time step
};

/// As extract_files(), of slice_field(). Without `with`, slices carry all point fields and, in formats that hold them,
/// all cell fields.
///
/// Errors   as extract_files() and slice_field(); invalid_argument: no shape, or a count of other shapes than planes
Result<ExtractNumbers> slice_files(const SliceJob& job, Caller& caller);

} // namespace isotet::jobs
