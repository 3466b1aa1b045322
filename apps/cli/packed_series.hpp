// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The packed grid of a series of time steps: only what changed from one step to the next is packed again.
#pragma once

#include <optional>

#include <isotet/grid.hpp>
#include <isotet/pack.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>

#include "extractor.hpp"
#include "fingerprint.hpp"

namespace isotet::cli {

class PackedSeries {
public:
    /// `steps` is how many times load() will be called: for one alone nothing is compared.
    PackedSeries(const PackOptions& options, std::size_t steps) : options_(options), several_(steps > 1) {}

    /// What load() had to do.
    enum class Work { packed, moved_points, set_field };

    /// Makes the packed grid that of this step, here and where the extractor has it: with the same cells as the step
    /// before only points and values are set. One that was packed again the extractor does not have.
    Result<Work> load(const Grid& grid, const PointField& field, Extractor& extractor, const Progress& progress);

    const PackedGrid& packed() const noexcept { return packed_; }

private:
    Result<Work> pack_again(const Grid& grid, const PointField& field, Extractor& extractor, const Progress& progress);

    PackOptions options_;
    bool several_;
    PackedGrid packed_;
    std::optional<Fingerprint> cells_, points_; ///< of the packed step; nothing before the first
};

} // namespace isotet::cli
