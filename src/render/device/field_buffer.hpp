// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Values that colour, and the colours: what isotet::DeviceColors stands for inside.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include <isotet/render.hpp>

#include "vulkan/context.hpp"

namespace isotet::render {

class FieldBuffer {
public:
    /// `count` values, the i-th of them the one that `number(i)` says. Places in the map where the scale is linear;
    /// where it is logarithmic values / lower end, so that the logarithm can be taken of what was interpolated.
    ///
    /// `coloring`   layout::by_vertex and so on
    static Result<std::unique_ptr<FieldBuffer>> upload(std::shared_ptr<vulkan::Context> context, const Array& values,
                                                       std::uint32_t coloring, std::uint64_t count,
                                                       const std::function<std::uint64_t(std::uint64_t)>& number,
                                                       const ColorScale& scale);

    std::shared_ptr<vulkan::Context> context; ///< before the buffers, so that it goes after them
    vulkan::Buffer values, table;
    ColorScale scale;
    std::uint32_t coloring = 0;
    std::uint64_t count = 0;
};

} // namespace isotet::render
