// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Numbers of tensors. Of a gradient component 3 i + j is the derivative of component i of the vector by coordinate j.
#pragma once

#include <span>

namespace isotet::core {

/// Second invariant of the velocity gradient: -1/2 tr(J J).
double q_criterion(std::span<const double> gradient);

/// The middle eigenvalue of S^2 + W^2, of the symmetric and the antisymmetric part (Jeong and Hussain 1995).
double lambda2(std::span<const double> gradient);

/// Von Mises stress of 6 components (xx, yy, zz, xy, yz, xz) or 9 (row by row).
double von_mises(std::span<const double> stress);

} // namespace isotet::core
