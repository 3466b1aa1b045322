// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What every renderer refuses.
#pragma once

#include <isotet/result.hpp>
#include <isotet/scene.hpp>

namespace isotet::render {

Result<void> check_options(const PictureOptions& options);
Result<void> check_opacity(double opacity);
Result<void> check_scale(const ColorScale& scale);
Result<void> check_lines(const DrawnLines& lines);

/// Whether as many values colour a surface as it has vertices or triangles.
Result<void> check_count(std::uint64_t values, std::uint64_t vertices, std::uint64_t triangles,
                         Association association);

} // namespace isotet::render
