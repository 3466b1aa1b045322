// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "packed/residency.hpp"

#include <numeric>

namespace isotet::core {

Residency::~Residency() = default;

std::vector<std::uint32_t> all_clusters(const Packed& packed) {
    std::vector<std::uint32_t> clusters(packed.clusters());
    std::iota(clusters.begin(), clusters.end(), 0U);
    return clusters;
}

Result<std::shared_ptr<const Packed>> whole_of(const std::shared_ptr<const Packed>& packed, const Progress& progress) {
    if (!packed->residency) return packed;
    return packed->residency->whole(progress);
}

} // namespace isotet::core
