// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "numbers/level.hpp"

namespace isotet::cpu {

using core::best_level;
using core::force_level;
using core::level;
using core::Level;
using core::name_of;

} // namespace isotet::cpu
