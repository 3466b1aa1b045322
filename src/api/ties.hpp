// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Counting ties: the certificate that comes with every surface.
#pragma once

#include <isotet/export.hpp>
#include <isotet/extract.hpp>
#include <isotet/progress.hpp>

#include "numbers/storage.hpp"
#include "packed/packed.hpp"

namespace isotet::api {

/// Fills tied_points, false_ties, near_tie and isovalue_stored.
/// `tied_points`  how many an engine found
/// Errors         of a grid that lies in a file, as Residency::bring()
/// Cost           nothing beyond what must be looked at: O(C) and the points of clusters whose range holds the isovalue
///                when there are tied points; the same for the nearest value of the field's type when it is stored
///                differently
template <class Real>
ISOTET_API Result<void> report_ties(const core::Packed& packed, double isovalue,
                                    const core::StoredIsovalue<Real>& stored, std::uint64_t tied_points,
                                    ExtractReport& report, const Progress& progress);

} // namespace isotet::api
