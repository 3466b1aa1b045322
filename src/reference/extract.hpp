// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The reference engine: the contract of extraction written down as plainly as possible, slow, serial, with maps. It
// judges all other engines, and packing too: of the packed grid it reads points, values and tets only, never ranges or
// seams.
#pragma once

#include "ops/extraction.hpp"

namespace isotet::reference {

/// Cost: O((T + V) log(T + V)) an isovalue, and some 200 bytes a tet.
template <class Real>
Result<ops::RawSurfaces> extract(const core::Packed& packed, const ops::Request<Real>& request,
                                 const Progress& progress);

} // namespace isotet::reference
