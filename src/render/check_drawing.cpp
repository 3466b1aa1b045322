// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "render/check_drawing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/core.h>

#include "base/errors.hpp"
#include "render/vector_math.hpp"

namespace isotet::render {

namespace {

constexpr std::size_t max_lines = std::numeric_limits<std::uint32_t>::max() / 6; // six corners each

constexpr std::uint32_t max_pixels_per_axis = 32768, max_samples = 8;

Result<void> check_camera(const Camera& camera) {
    const auto is_unit = [](const std::array<double, 3>& v) { return std::abs(dot(v, v) - 1) < 1e-6; };
    if (!is_unit(camera.direction) || !is_unit(camera.up) || std::abs(dot(camera.direction, camera.up)) > 1e-6)
        return invalid_argument("a camera whose direction and up are not unit vectors at right angles");
    if (!std::ranges::all_of(camera.target, [](double x) { return std::isfinite(x); }))
        return invalid_argument("a camera whose target is not finite");
    const auto positive = [](double x) { return x > 0 && std::isfinite(x); };
    if (camera.projection == Projection::parallel) {
        if (positive(camera.height)) return {};
        return invalid_argument(
            fmt::format("a camera that shows a height of {}, but it must be positive", camera.height));
    }
    if (!positive(camera.distance))
        return invalid_argument(fmt::format("a camera at a distance of {}, but it must be positive", camera.distance));
    if (camera.angle >= 0.1 && camera.angle <= 170) return {};
    return invalid_argument(
        fmt::format("a camera with an angle of {} degrees, but it must be from 0.1 to 170", camera.angle));
}

} // namespace

Result<void> check_options(const PictureOptions& options) {
    for (const std::uint32_t pixels : {options.width, options.height}) {
        if (pixels >= 1 && pixels <= max_pixels_per_axis) continue;
        return invalid_argument(fmt::format("a picture of {} x {} pixels, but each must be from 1 to {}", options.width,
                                            options.height, max_pixels_per_axis));
    }
    if (options.samples < 1 || options.samples > max_samples)
        return invalid_argument(
            fmt::format("{} samples an axis, but they must be from 1 to {}", options.samples, max_samples));
    if (!(options.occlusion >= 0 && options.occlusion <= 1))
        return invalid_argument(fmt::format("an occlusion of {}, but it must be from 0 to 1", options.occlusion));
    return check_camera(options.camera);
}

Result<void> check_opacity(double opacity) {
    if (opacity >= 0 && opacity <= 1) return {};
    return invalid_argument(fmt::format("an opacity of {}, but it must be from 0 to 1", opacity));
}

Result<void> check_scale(const ColorScale& scale) {
    if (std::isfinite(scale.lower) && std::isfinite(scale.upper) && scale.lower < scale.upper &&
        (!scale.logarithmic || scale.lower > 0))
        return {};
    return Error{ErrorCode::invalid_argument,
                 fmt::format("a colour scale from {} to {}, but it must run from a smaller{} to a larger finite value",
                             scale.lower, scale.upper, scale.logarithmic ? " positive" : "")};
}

Result<void> check_lines(const DrawnLines& lines) {
    if (!(lines.width > 0 && std::isfinite(lines.width)))
        return invalid_argument(fmt::format("lines {} pixels wide, but the width must be positive", lines.width));
    if (lines.lines.size() > max_lines)
        return invalid_argument(fmt::format("{} lines, but {} can be drawn at most", lines.lines.size(), max_lines));
    for (std::size_t i = 0; i < lines.lines.size(); ++i)
        for (const std::array<double, 3>& end : lines.lines[i])
            if (!std::ranges::all_of(end, [](double x) { return std::isfinite(x); }))
                return invalid_argument(fmt::format("line {} has an end that is not finite", i));
    return {};
}

Result<void> check_count(std::uint64_t values, std::uint64_t vertices, std::uint64_t triangles,
                         Association association) {
    const bool of_triangles = association == Association::cell;
    const std::uint64_t needed = of_triangles ? triangles : vertices;
    if (values == needed) return {};
    return invalid_argument(fmt::format("{} values shall colour a mesh with {} {}", values, needed,
                                        of_triangles ? "triangles" : "vertices"));
}

} // namespace isotet::render
