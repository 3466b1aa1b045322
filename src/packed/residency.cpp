// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "packed/residency.hpp"

namespace isotet::core {

Residency::~Residency() = default;

Result<std::shared_ptr<const Packed>> whole_of(const std::shared_ptr<const Packed>& packed, const Progress& progress) {
    if (!packed->residency) return packed;
    return packed->residency->whole(progress);
}

} // namespace isotet::core
