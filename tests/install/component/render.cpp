// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Letters beside a picture, for which no device is needed.
#include <isotet/render.hpp>

int main() {
    isotet::Annotation annotation;
    annotation.caption = "speed";
    const isotet::PictureSize whole{400, 300};
    const auto room = isotet::room_beside(annotation, whole).value();
    isotet::Picture scene{room->width, room->height, {}};
    scene.pixels.resize(std::size_t{scene.width} * scene.height, {255, 255, 255, 255});
    return isotet::annotate(scene, annotation, whole, {1, 1, 1, 1}) ? 0 : 1;
}
