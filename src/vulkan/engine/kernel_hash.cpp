// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "vulkan/engine/kernel_hash.hpp"

#include <string_view>
#include <vector>

#include "engine_shaders.hpp"
#include "shaders.hpp"

namespace isotet::vulkan {

std::uint64_t hash_of(std::span<const ShaderCode* const> kernels) {
    std::uint64_t hash = 0xcbf29ce484222325u;
    const auto add = [&](std::span<const std::byte> bytes) {
        for (const std::byte byte : bytes) hash = (hash ^ static_cast<std::uint64_t>(byte)) * 0x100000001b3u;
    };
    for (const ShaderCode* kernel : kernels) {
        add(std::as_bytes(std::span(std::string_view(kernel->name))));
        add(std::as_bytes(kernel->words));
    }
    return hash;
}

std::uint64_t kernel_hash() {
    std::vector<const ShaderCode*> all(std::begin(engine::every), std::end(engine::every));
    all.insert(all.end(), std::begin(shaders::every), std::end(shaders::every));
    return hash_of(all);
}

} // namespace isotet::vulkan
