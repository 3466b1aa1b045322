// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "render/device/view.hpp"

namespace isotet::render {

void fill(layout::View& view, const Sight& sight, const PictureOptions& options, const Part& part) {
    const auto cut = [&](const Row& whole, double pixels, double begin, double count) {
        const double scale = pixels / count, shift = -(2 * begin + count - pixels) / count;
        Row row{{}, whole.shift * scale + sight.w.shift * shift};
        for (std::size_t axis = 0; axis < 3; ++axis)
            row.along[axis] = whole.along[axis] * scale + sight.w.along[axis] * shift;
        return row;
    };
    const Row rows[4] = {cut(sight.x, options.width, part.x, part.width),
                         cut(sight.y, options.height, part.y, part.height), sight.z, sight.w};
    for (std::size_t column = 0; column < 4; ++column) {
        const auto number = [&](const Row& r) { return static_cast<float>(column < 3 ? r.along[column] : r.shift); };
        view.clip_from_scene.columns[column] = {number(rows[0]), number(rows[1]), number(rows[2]), number(rows[3])};
    }
    view.eye = layout::vector(sight.eye);
    view.parallel = sight.parallel;
    view.up = layout::vector(sight.up);
    view.width = part.width;
    view.height = part.height;
}

} // namespace isotet::render
