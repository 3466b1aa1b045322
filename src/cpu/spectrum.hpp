// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <isotet/progress.hpp>

#include "ops/spectrum.hpp"

namespace isotet::cpu {

/// As ops/spectrum.hpp. Parts of the sums are those of blocks of cells, which only the numbers of cells and isovalues
/// decide. Where progress.cancelled() afterwards, the numbers mean nothing.
ops::Spectrum contour_spectrum(const ops::SpectrumInput& input, const Progress& progress);

} // namespace isotet::cpu
