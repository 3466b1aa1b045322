// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/draw.hpp>

#include <algorithm>
#include <atomic>

#include "base/carry_out.hpp"
#include "base/parallel.hpp"
#include "render/check_drawing.hpp"
#include "render/cpu/bins.hpp"
#include "render/cpu/tile.hpp"

namespace isotet {

namespace {

using render::Sheet;

/// What is opaque before what is translucent.
Result<std::vector<Sheet>> sheets_of(const Scene& scene, const render::Space& space, const render::Screen& screen) {
    std::vector<Sheet> sheets;
    for (const DrawnLines& lines : scene.lines) {
        Result<Sheet> sheet = render::sheet_of(lines, space, screen);
        if (!sheet) return sheet.error();
        sheets.push_back(*std::move(sheet));
    }
    for (const DrawnSurface& surface : scene.surfaces) {
        if (surface.opacity == 0 || (surface.triangles && surface.triangles->triangle_count() == 0)) continue;
        Result<Sheet> sheet = render::sheet_of(surface, space, screen);
        if (!sheet) return sheet.error();
        sheets.push_back(*std::move(sheet));
    }
    std::ranges::stable_sort(sheets, {}, &Sheet::translucent);
    return sheets;
}

Result<Picture> draw_on_cpu(const Scene& scene, const PictureOptions& options, const Progress& progress) {
    if (Result<void> right = render::check_options(options); !right) return right.error();
    const render::Space space(scene.bounds);
    const render::Screen screen{space.look(options.camera, options.width, options.height), options.width,
                                options.height, options.samples};
    const Result<std::vector<Sheet>> sheets = sheets_of(scene, space, screen);
    if (!sheets) return sheets.error();
    if (progress.cancelled()) return Error{ErrorCode::cancelled, "drawing was cancelled"};

    // A tile's samples fit a core's cache.
    const render::Tiling tiling{options.width, options.height, options.samples, options.samples > 3 ? 16U : 32U};
    const render::Bins bins(*sheets, tiling, screen.sight, progress);
    render::TileScene shared{*sheets,
                             screen,
                             tiling,
                             render::linear_light(options.background),
                             std::clamp(options.background.opacity, 0.0F, 1.0F),
                             {}};
    Picture picture{options.width, options.height, {}};
    picture.pixels.resize(std::size_t{options.width} * options.height);
    std::atomic<std::size_t> done = 0;
    core::parallel_pieces(tiling.tiles(), 4, progress, [&](std::size_t begin, std::size_t end) {
        render::Tile tile(shared);
        for (std::size_t i = begin; i < end; ++i) tile.draw(i, bins.of(i), picture);
        progress("draw", static_cast<double>(done += end - begin) / static_cast<double>(tiling.tiles()));
    });
    if (progress.cancelled()) return Error{ErrorCode::cancelled, "drawing was cancelled"};
    return picture;
}

} // namespace

Result<Picture> draw(const Scene& scene, const PictureOptions& options, const Run& run) {
    return core::carry_out("drawing", run,
                           [&](const Progress& progress) { return draw_on_cpu(scene, options, progress); });
}

} // namespace isotet
