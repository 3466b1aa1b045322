// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Counting ties: the certificate that comes with every surface.
#pragma once

#include <isotet/extract.hpp>

#include "core/packed.hpp"

namespace isotet::api {

/// Fills tied_points, false_ties, near_tie and isovalue_stored.
/// Cost   O(C) and the points of clusters whose range holds the isovalue
template <class Real>
void count_ties(const core::Packed& packed, double isovalue, Real stored, ExtractReport& report);

} // namespace isotet::api
