// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Volumes on the CPU against closed forms: homogeneous media, linear fields, steps, and isosurfaces met by rays.
#include <gtest/gtest.h>

#include <isotet/extract.hpp>
#include <isotet/render.hpp>

#include "draw/volumes.hpp"
#include "support/small_grid.hpp"

namespace isotet::test {
namespace {

const OpacityCurve half_opaque{{{0, 0.5}}};

/// The largest difference between what comes through and exp(-depth(ray)), beside rays along the silhouette.
template <class Depth>
double worst_error(const VolumeCase& one, const Depth& depth) {
    const RayValues rays = rays_of(one.scene, one.picture);
    double worst = 0;
    for (std::uint32_t y = 0; y < one.picture.height; ++y)
        for (std::uint32_t x = 0; x < one.picture.width; ++x) {
            const double expected = std::exp(-depth(user_ray(one.picture, x, y)));
            if (expected < 0.002) continue; // ends early
            worst = std::max(worst, std::abs(rays.slabs[std::size_t{y} * one.picture.width + x].through - expected));
        }
    return worst;
}

Grid moved(Grid grid, double factor, double shift) {
    std::vector<double> points(grid.points.tuples() * 3);
    for (std::size_t i = 0; i < points.size(); ++i) points[i] = grid.points.at(i / 3, i % 3) * factor + shift;
    grid.points = Array::own(std::move(points), 3);
    return grid;
}

TEST(Volume, AHomogeneousMediumLetsThroughWhatItsLengthSays) {
    for (const char* shape : {"kuhn", "perturbed", "layer", "mixed", "hex"})
        for (const Projection projection : {Projection::perspective, Projection::parallel}) {
            VolumeCase one = made_volume(shape, 7, "gyroid", half_opaque);
            one.volume().opacity_length = 1.3;
            one.look_from(31, 23, projection);
            const double kappa = std::log(2.0) / 1.3;
            EXPECT_LT(worst_error(one,
                                  [&](const UserRay& ray) {
                                      return kappa * inside_box(ray, {{-1, -1, -1}, {1, 1, 1}}).length();
                                  }),
                      2e-5)
                << shape << static_cast<int>(projection);
        }
}

TEST(Volume, FacesAlongTheViewNeitherLeakNorCountTwice) {
    for (const Projection projection : {Projection::perspective, Projection::parallel})
        for (const View view : {View::plus_x, View::minus_y, View::plus_z}) {
            VolumeCase one = made_volume("kuhn", 8, "sphere", half_opaque);
            one.picture.width = one.picture.height = 65; // a ray through the middle, along faces and edges
            one.picture.camera = camera_of(view, projection);
            one.picture.camera.fit(one.scene.bounds, 1);
            EXPECT_LT(worst_error(one,
                                  [&](const UserRay& ray) {
                                      return std::log(2.0) * inside_box(ray, {{-1, -1, -1}, {1, 1, 1}}).length();
                                  }),
                      2e-5)
                << name_of(view) << static_cast<int>(projection);
        }
}

TEST(Volume, SizeAndPlaceOfAGridDoNotMatter) {
    const Grid grid = made_grid("perturbed", 6, {"gyroid"});
    for (const auto& [factor, shift] : {std::pair(1e-6, 0.0), std::pair(1e6, 0.0), std::pair(1.0, 5e5)}) {
        VolumeCase one = volume_of(moved(grid, factor, shift), point_field(grid), half_opaque);
        one.volume().opacity_length = factor;
        const Box box{{shift - factor, shift - factor, shift - factor},
                      {shift + factor, shift + factor, shift + factor}};
        EXPECT_LT(worst_error(
                      one, [&](const UserRay& ray) { return std::log(2.0) * inside_box(ray, box).length() / factor; }),
                  2e-5)
            << factor << " " << shift;
    }
}

TEST(Volume, AnEyeInsideSeesWhatIsBeforeIt) {
    for (const char* shape : {"kuhn", "perturbed"})
        for (const std::uint64_t side : {1U, 6U}) {
            VolumeCase one = made_volume(shape, side, "gyroid", half_opaque);
            one.picture.camera.target = {0.1, 0.05, 0.02};
            one.picture.camera.distance = 0.2;
            one.picture.camera.angle = 70;
            const auto sight = render::Space(one.scene.bounds).look(one.picture.camera, 96, 64);
            const double nearest = render::Rays(sight, 96, 64).nearest();
            const auto& d = one.picture.camera.direction;
            EXPECT_LT(worst_error(one,
                                  [&](const UserRay& ray) {
                                      const double slant =
                                          -(ray.along[0] * d[0] + ray.along[1] * d[1] + ray.along[2] * d[2]);
                                      return std::log(2.0) *
                                             inside_box(ray, {{-1, -1, -1}, {1, 1, 1}}, nearest / slant).length();
                                  }),
                      2e-5)
                << shape << side;
        }
}

TEST(Volume, CellsWithoutDataAndHolesAreEmpty) {
    Grid grid = made_grid("kuhn", 8, {"gyroid"});
    std::vector<float> values(grid.points.tuples());
    for (std::size_t i = 0; i < values.size(); ++i) {
        values[i] = static_cast<float>(grid.point_fields[0].values.at(i));
        if (grid.points.at(i, 0) > 0.5) values[i] = i % 2 == 0 ? NAN : INFINITY;
    }
    const auto depth_in = [](const std::vector<Box>& boxes) {
        return [=](const UserRay& ray) {
            double sum = 0;
            for (const Box& box : boxes) sum += inside_box(ray, box).length();
            return std::log(2.0) * sum;
        };
    };
    EXPECT_LT(worst_error(volume_of(grid, field_of(values), half_opaque), depth_in({{{-1, -1, -1}, {0.5, 1, 1}}})),
              2e-5);
    // Two parts, one behind the other: the middle two of eight layers of cubes are gone.
    std::vector<std::int64_t> kept;
    for (std::size_t i = 0; i < grid.cells.count(); ++i) {
        double middle = 0;
        for (std::size_t k = 0; k < 4; ++k)
            middle += grid.points.at(static_cast<std::size_t>(grid.cells.connectivity.at(4 * i + k)), 1) / 4;
        for (std::size_t k = 0; k < 4 && std::abs(middle) > 0.25; ++k)
            kept.push_back(static_cast<std::int64_t>(grid.cells.connectivity.at(4 * i + k)));
    }
    Grid two = grid;
    two.cells.connectivity = Array::own(std::move(kept));
    EXPECT_LT(worst_error(volume_of(two, point_field(grid), half_opaque),
                          depth_in({{{-1, -1, -1}, {1, -0.25, 1}}, {{-1, 0.25, -1}, {1, 1, 1}}})),
              2e-5);
}

TEST(Volume, ClippingPlanesCutRays) {
    VolumeCase one = made_volume("perturbed", 6, "gyroid", half_opaque);
    one.volume().clips = {{{2, 0, 0}, 0.46}, {{0, 0, -1}, 0.31}};
    EXPECT_LT(worst_error(one,
                          [](const UserRay& ray) {
                              return std::log(2.0) * inside_box(ray, {{-1, -1, -0.31}, {0.23, 1, 1}}).length();
                          }),
              2e-5);
}

/// The depth of opacity that is linear between two values, over a length along which the value goes from a to b.
double depth_of_ramp(double a, double b, double lower, double upper, double top) {
    const auto up_to = [&](double value) {
        const double through = 1 - top * (value - lower) / (upper - lower);
        return (through * std::log(through) + 1 - through) * (upper - lower) / top;
    };
    return std::abs(b - a) < 1e-9 ? -std::log(1 - top * (a - lower) / (upper - lower))
                                  : (up_to(b) - up_to(a)) / (b - a);
}

TEST(Volume, ShadingLightsColoursByTheGradientAndNothingElse) {
    const std::array<double, 3> normal{1 / std::sqrt(14.0), 2 / std::sqrt(14.0), 3 / std::sqrt(14.0)};
    const auto dot = [](const std::array<double, 3>& a, const std::array<double, 3>& b) {
        return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    };
    for (const char* shape : {"perturbed", "hex"})
        for (const Projection projection : {Projection::perspective, Projection::parallel}) {
            VolumeCase one = made_volume(shape, 5, "plane", half_opaque);
            one.look_from(120, 23, projection);
            const RayValues plain = rays_of(one.scene, one.picture);
            one.volume().shaded = true;
            const RayValues shaded = rays_of(one.scene, one.picture);
            std::size_t seen = 0;
            for (std::uint32_t i = 0; i < plain.slabs.size(); ++i) {
                const render::Slab &a = plain.slabs[i], &b = shaded.slabs[i];
                ASSERT_EQ(a.through, b.through);
                if (a.through > 0.9F) continue;
                ++seen;
                const double along = dot(normal, user_ray(one.picture, i % 96, i / 96).along), facing = std::abs(along),
                             up = (along > 0 ? -1 : 1) * dot(normal, one.picture.camera.up);
                const double light = 0.16 + 0.84 * facing + 0.22 * (0.5 + 0.5 * up) * (1 - facing);
                for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(b.light[k], a.light[k] * light, 2e-3 * a.light[k]);
            }
            EXPECT_GT(seen, 1000U);
        }
    // A constant field has no side that could be lit.
    const Grid grid = made_grid("kuhn", 3, {});
    VolumeCase one = volume_of(grid, field_of(std::vector<float>(grid.points.tuples(), 1)), half_opaque);
    const Picture plain = draw(one.scene, one.picture).value();
    one.volume().shaded = true;
    EXPECT_TRUE(draw(one.scene, one.picture).value().pixels == plain.pixels);
}

TEST(Volume, ALinearFieldIsIntegratedExactly) {
    for (const char* shape : {"kuhn", "perturbed", "layer", "hex"}) {
        const Grid grid = made_grid(shape, 6, {"plane"});
        VolumeCase one = volume_of(grid, point_field(grid), {});
        const double end = 6 / std::sqrt(14.0);
        one.volume().opacity.points = {{-end, 0}, {end, 0.6}};
        for (const double azimuth : {31.0, 120.0}) { // nearly along the planes of equal values, and across
            one.look_from(azimuth, 23);
            EXPECT_LT(worst_error(one,
                                  [&](const UserRay& ray) {
                                      const Interval in = inside_box(ray, {{-1, -1, -1}, {1, 1, 1}});
                                      if (in.length() == 0) return 0.0;
                                      const auto value = [&](double t) {
                                          const auto p = ray.at(t);
                                          return (p[0] + 2 * p[1] + 3 * p[2]) / std::sqrt(14.0);
                                      };
                                      return in.length() * depth_of_ramp(value(in.from), value(in.to), -end, end, 0.6);
                                  }),
                      3e-5)
                << shape << azimuth;
        }
    }
}

TEST(Volume, AStepInsideOneHugeTetIsWhereItIs) {
    const Grid grid = tet_grid({{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {0, 0, 4}}, {{0, 1, 2, 3}});
    VolumeCase one = volume_of(grid, field_of<float>({0, 4, 0, 0}), {{{1, 0}, {1, 0.5}, {2.5, 0.5}, {2.5, 0}}});
    EXPECT_LT(worst_error(one,
                          [&](const UserRay& ray) {
                              // x between 1 and 2.5, in the tet: beyond the planes of 0, and before x + y + z = 4.
                              Interval in = inside_box(ray, {{1, 0, 0}, {2.5, 4, 4}});
                              const double sum = ray.origin[0] + ray.origin[1] + ray.origin[2],
                                           slope = ray.along[0] + ray.along[1] + ray.along[2];
                              (slope > 0 ? in.to : in.from) =
                                  slope > 0 ? std::min(in.to, (4 - sum) / slope) : std::max(in.from, (4 - sum) / slope);
                              return std::log(2.0) * in.length();
                          }),
              2e-3)
        << "a step is sharp to a 1000th of its opaque values";
}

TEST(Volume, IsosurfacesMetByRaysAreTheExtractedOnes) {
    for (const char* shape : {"kuhn", "shuffled"}) {
        VolumeCase one = made_volume(shape, 12, "gyroid", {});
        one.picture.width = 160;
        one.picture.height = 120;
        one.picture.samples = 1;
        one.look_from(31, 23);
        one.volume().isosurfaces = {{0.2, {0.9F, 0.5F, 0.2F, 1}}};
        const Picture by_rays = draw(one.scene, one.picture).value();
        const Surface surface = extract(*one.grid, 0.2).value().surface;
        Scene extracted;
        extracted.bounds = one.scene.bounds;
        extracted.surfaces.emplace_back().triangles = &surface;
        extracted.surfaces[0].color = {0.9F, 0.5F, 0.2F, 1};
        const Picture by_triangles = draw(extracted, one.picture).value();
        const std::array<std::uint8_t, 4> white{255, 255, 255, 255};
        std::size_t other = 0, covered = 0, unlike = 0;
        for (std::size_t i = 0; i < by_rays.pixels.size(); ++i) {
            const auto &a = by_rays.pixels[i], &b = by_triangles.pixels[i];
            other += (a == white) != (b == white);
            covered += a != white;
            for (std::size_t k = 0; k < 3; ++k) unlike += std::abs(a[k] - b[k]) > 2 ? 1 : 0;
        }
        EXPECT_GT(covered, 5000U);
        EXPECT_LE(other, covered / 2000) << "places of triangles are rounded to 256ths of a pixel";
        EXPECT_LE(unlike, 3 * covered / 200) << "beside edges the triangle next to it";
    }
}

TEST(Volume, IsosurfacesLieOnTheirSurface) {
    VolumeCase one = made_volume("kuhn", 10, "plane", {});
    one.volume().isosurfaces = {{0.3, {}}, {-0.4, {}}};
    one.look_from(120, 40);
    const RayValues rays = rays_of(one.scene, one.picture);
    const auto sight = render::Space(one.scene.bounds).look(one.picture.camera, 96, 64);
    std::size_t hits = 0;
    for (std::uint32_t y = 0; y < 64; ++y)
        for (std::uint32_t x = 0; x < 96; ++x) {
            const UserRay ray = user_ray(one.picture, x, y);
            const Interval in = inside_box(ray, {{-1, -1, -1}, {1, 1, 1}});
            const double start = (ray.origin[0] + 2 * ray.origin[1] + 3 * ray.origin[2]) / std::sqrt(14.0),
                         slope = (ray.along[0] + 2 * ray.along[1] + 3 * ray.along[2]) / std::sqrt(14.0);
            double nearest = INFINITY;
            for (const double isovalue : {0.3, -0.4}) {
                const double t = (isovalue - start) / slope;
                if (t >= in.from && t <= in.to) nearest = std::min(nearest, t);
            }
            const render::RayHit& hit = rays.hits[std::size_t{y} * 96 + x];
            if (std::abs(nearest - in.from) < 1e-3 || std::abs(nearest - in.to) < 1e-3) continue;
            EXPECT_EQ(hit.exists(), nearest < INFINITY);
            if (!hit.exists()) continue;
            ++hits;
            EXPECT_NEAR(hit.distance * render::Rays(sight, 96, 64).at(x + render::ray_x, y + render::ray_y).stretch,
                        nearest, 1e-4);
        }
    EXPECT_GT(hits, 1000U);
}

} // namespace
} // namespace isotet::test
