// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>

#include "vulkan/shader_code.hpp"

namespace isotet::vulkan {

/// FNV-1a over names and SPIR-V: another one when any of these kernels changes.
std::uint64_t hash_of(std::span<const ShaderCode* const> kernels);

/// Of all kernels of the engine and of the self-test.
std::uint64_t kernel_hash();

} // namespace isotet::vulkan
