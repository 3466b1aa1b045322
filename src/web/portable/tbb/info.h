// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "serial.h"
