// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Arrays that become buffers on the device.
#pragma once

#include <span>
#include <string_view>

#include <isotet/array.hpp>

#include "base/buffer.hpp"
#include "base/parallel.hpp"
#include "vulkan/context.hpp"

namespace isotet::render {

inline Result<vulkan::Buffer> send(vulkan::Context& context, std::span<const std::byte> bytes, std::string_view name) {
    Result<vulkan::Buffer> buffer = context.memory().take(bytes.size(), vulkan::Where::device, name);
    if (!buffer) return buffer;
    if (bytes.empty()) return buffer;
    if (Result<void> sent = context.staging().upload(*buffer, 0, bytes); !sent) return sent.error();
    return buffer;
}

template <class T>
Result<vulkan::Buffer> send(vulkan::Context& context, const core::Buffer<T>& scalars, std::string_view name) {
    return send(context, std::as_bytes(std::span(scalars.data(), scalars.size())), name);
}

/// The scalars of an array, as `T`.
template <class T>
Result<vulkan::Buffer> send(vulkan::Context& context, const Array& array, std::string_view name) {
    core::Buffer<T> scalars(array.size());
    array.visit([&](auto from) {
        core::parallel_each(from.size(), std::size_t{1} << 16,
                            [&](std::size_t i) { scalars[i] = static_cast<T>(from[i]); });
    });
    return send(context, scalars, name);
}

} // namespace isotet::render
