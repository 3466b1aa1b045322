// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "numbers/at_level.hpp"

namespace isotet::cpu {

using core::at_level;

} // namespace isotet::cpu
