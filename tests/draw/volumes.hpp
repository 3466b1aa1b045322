// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Volumes that are drawn, and what their rays let through, as numbers.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <numbers>
#include <vector>

#include <isotet/fields.hpp>
#include <isotet/make.hpp>
#include <isotet/pack.hpp>
#include <isotet/scene.hpp>

#include "render/cpu/draw_tuned.hpp"
#include "render/volume/volume_tile.hpp"

namespace isotet::test {

/// A packed grid and how it is drawn; other members may be changed.
struct VolumeCase {
    std::shared_ptr<PackedGrid> grid;
    Scene scene;
    PictureOptions picture;

    DrawnVolume& volume() { return scene.volumes[0]; }
    void look_from(double azimuth, double elevation, Projection projection = Projection::perspective) {
        picture.camera = camera_of(azimuth, elevation, UpAxis::plus_z, projection);
        picture.camera.fit(scene.bounds, static_cast<double>(picture.width) / picture.height);
    }
};

inline VolumeCase volume_of(const Grid& grid, const PointField& field, OpacityCurve opacity,
                            const PackOptions& options = {}) {
    VolumeCase out;
    out.grid = std::make_shared<PackedGrid>(pack(grid, field, options).value());
    DrawnVolume& volume = out.scene.volumes.emplace_back();
    volume.grid = out.grid.get();
    volume.scale.lower = out.grid->field().lower;
    volume.scale.upper = std::max(out.grid->field().upper, volume.scale.lower + 1e-9);
    volume.opacity = std::move(opacity);
    out.scene.bounds = bounds_of(*out.grid);
    out.picture.width = 96;
    out.picture.height = 64;
    out.look_from(31, 23);
    return out;
}

inline VolumeCase made_volume(const char* shape, std::uint64_t side, const char* field, OpacityCurve opacity) {
    const Grid grid = make_grid({.shape = shape, .side = side, .fields = {field}}).value();
    return volume_of(grid, find_field(grid, field).value(), std::move(opacity));
}

/// What the media of a scene give each ray.
struct RayValues {
    std::vector<render::Slab> slabs; ///< a pixel, row by row
    std::vector<render::RayHit> hits;
    VolumeWork work;
};

inline RayValues rays_of(const Scene& scene, const PictureOptions& picture, const render::VolumeTuning& tuning = {}) {
    const render::Space space(scene.bounds);
    const render::Tiling tiling{picture.width, picture.height, 1, 32};
    const auto sight = space.look(picture.camera, picture.width, picture.height);
    const auto volumes = std::make_unique<render::VolumeScene>(scene, space, sight, tiling, tuning);
    volumes->place(tiling, Progress()).value();
    const auto tile = std::make_unique<render::VolumeTile>(*volumes);
    RayValues out;
    out.slabs.resize(std::size_t{picture.width} * picture.height);
    out.hits.resize(out.slabs.size());
    for (std::uint32_t number = 0; number < tiling.tiles(); ++number) {
        const std::uint32_t column = number % tiling.columns() * 32, row = number / tiling.columns() * 32;
        tile->start(number, column, row);
        tile->find_hits();
        for (std::size_t i = 0; i < 1024; ++i) tile->add_stops({});
        tile->compose_media();
        for (std::uint32_t i = 0; i < 1024; ++i) {
            const std::size_t x = column + i % 32, y = row + i / 32;
            if (x >= picture.width || y >= picture.height) continue;
            out.slabs[y * picture.width + x] = tile->slabs(i)[0];
            out.hits[y * picture.width + x] = tile->hit(i);
        }
    }
    out.work = tile->work();
    return out;
}

/// The ray through the middle of a pixel, in the user's coordinates: origin + t * along, |along| = 1.
struct UserRay {
    std::array<double, 3> origin, along;

    std::array<double, 3> at(double t) const {
        return {origin[0] + t * along[0], origin[1] + t * along[1], origin[2] + t * along[2]};
    }
};

inline UserRay user_ray(const PictureOptions& picture, double x, double y) {
    const Camera& camera = picture.camera;
    const auto& d = camera.direction;
    const auto& up = camera.up;
    const std::array<double, 3> right{up[1] * d[2] - up[2] * d[1], up[2] * d[0] - up[0] * d[2],
                                      up[0] * d[1] - up[1] * d[0]};
    const bool parallel = camera.projection == Projection::parallel;
    const double half = parallel ? camera.height / 2 : std::tan(camera.angle * std::numbers::pi / 360);
    const double across = (2 * (x + render::ray_x) / picture.width - 1) * half * picture.width / picture.height,
                 upwards = (1 - 2 * (y + render::ray_y) / picture.height) * half;
    UserRay ray;
    double square = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const double aside = across * right[k] + upwards * up[k];
        ray.origin[k] = camera.target[k] + camera.distance * d[k] + (parallel ? aside : 0);
        ray.along[k] = parallel ? -d[k] : aside - d[k];
        square += ray.along[k] * ray.along[k];
    }
    for (double& part : ray.along) part /= std::sqrt(square);
    return ray;
}

/// Where a ray is inside a box; from > to: nowhere.
struct Interval {
    double from, to;
    double length() const { return std::max(0.0, to - from); }
};

inline Interval inside_box(const UserRay& ray, const Box& box, double nearest = -INFINITY) {
    Interval out{nearest, INFINITY};
    for (std::size_t k = 0; k < 3; ++k) {
        const double a = (box.lower[k] - ray.origin[k]) / ray.along[k],
                     b = (box.upper[k] - ray.origin[k]) / ray.along[k];
        out.from = std::max(out.from, std::min(a, b));
        out.to = std::min(out.to, std::max(a, b));
    }
    return out;
}

} // namespace isotet::test
