// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "ops/spectrum.hpp"

namespace isotet::reference {

/// As ops/spectrum.hpp, by cutting every tet at every isovalue.
ops::Spectrum contour_spectrum(const ops::SpectrumInput& input);

} // namespace isotet::reference
