// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Does this device compute what the processor computes? Asked once, when it is opened.
#pragma once

#include <string>
#include <vector>

#include <isotet/result.hpp>

#include "vulkan/kernels/shared/self_test.h"

namespace isotet::vulkan {

class Context;

/// A few thousand cases, the same in every run: the hardest divisions, products of the smallest numbers that occur,
/// sums that a fused multiply-add would round otherwise, normals that cancel, ordinary ones.
std::vector<layout::SelfTestCase> self_test_cases();

/// What the contract says, computed here.
layout::SelfTestAnswer self_test_answer(const layout::SelfTestCase& given);

/// Runs the cases on the device in one dispatch. What the user should know, a sentence; empty when all bits are right.
///
/// Cost     a millisecond, after the kernel is built
/// Errors   as Recorder::run
Result<std::string> self_test(Context& context);

} // namespace isotet::vulkan
