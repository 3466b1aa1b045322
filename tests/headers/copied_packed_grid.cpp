// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Must not compile: a packed grid may have gigabytes, so it is moved or borrowed.
#include <isotet/pack.hpp>

isotet::PackedGrid costly(const isotet::PackedGrid& packed) { return packed; }
