// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/contour.hpp>

isotet::Contour copy(const isotet::Contour& contour) { return contour; }
