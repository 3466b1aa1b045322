// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Pictures of volumes do not show how points are numbered, cells ordered, work divided or lists kept; nor do they differ
// from what every tet and every ray give. Surfaces before, in and behind volumes.
#include <algorithm>
#include <atomic>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include <isotet/fields.hpp>
#include <isotet/packed_file.hpp>
#include <isotet/render.hpp>

#include "draw/volumes.hpp"
#include "numbers/level.hpp"
#include "render/cpu/encode.hpp"
#include "support/random_grid.hpp"
#include "support/seeds.hpp"
#include "support/temporary_folder.hpp"
#include "support/small_grid.hpp"

namespace isotet::test {
namespace {

const OpacityCurve two_peaks{{{-0.9, 0}, {-0.6, 0.9}, {-0.42, 0}, {0.48, 0}, {0.66, 0.95}, {0.84, 0}}};

Picture picture_of(const VolumeCase& one, int threads = 1) {
    return draw(one.scene, one.picture, {.threads = threads}).value();
}

/// A sheet at right angles to x, twice as large as the cube, that leans by `slant`.
Surface sheet_at(double x, double slant = 0) {
    Surface sheet;
    std::vector<double> corners;
    for (const auto& [y, z] : {std::pair(-2, -2), std::pair(2, -2), std::pair(2, 2), std::pair(-2, 2)})
        corners.insert(corners.end(), {x + slant * z, double(y), double(z)});
    sheet.positions = Array::own(std::move(corners), 3);
    sheet.triangles = Array::own(std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3}, 3);
    return sheet;
}

TEST(VolumeBytes, AreTheSameHoweverPointsAndCellsAreNumbered) {
    const Grid grid = made_grid("perturbed", 8, {"gyroid"});
    const std::size_t points = grid.points.tuples(), tets = grid.cells.count();
    std::mt19937 random(5);
    std::vector<std::uint32_t> to(points), order(tets);
    for (std::size_t i = 0; i < points; ++i) to[i] = static_cast<std::uint32_t>(i);
    for (std::size_t i = 0; i < tets; ++i) order[i] = static_cast<std::uint32_t>(i);
    std::shuffle(to.begin(), to.end(), random);
    std::shuffle(order.begin(), order.end(), random);
    std::vector<float> coordinates(3 * points), values(points);
    for (std::size_t i = 0; i < points; ++i) {
        for (std::size_t k = 0; k < 3; ++k) coordinates[3 * to[i] + k] = static_cast<float>(grid.points.at(i, k));
        values[to[i]] = static_cast<float>(grid.point_fields[0].values.at(i));
    }
    std::vector<std::uint32_t> corners;
    for (const std::uint32_t tet : order)
        for (const std::size_t k : {1U, 0U, 2U, 3U})
            corners.push_back(to[static_cast<std::size_t>(grid.cells.connectivity.at(4 * tet + k))]);
    Grid other = grid;
    other.points = Array::own(std::move(coordinates), 3);
    other.cells.connectivity = Array::own(std::move(corners));
    for (const Projection projection : {Projection::perspective, Projection::parallel}) {
        VolumeCase one = volume_of(grid, point_field(grid), two_peaks),
                   two = volume_of(other, field_of(values), two_peaks);
        one.look_from(31, 23, projection);
        two.picture = one.picture;
        for (VolumeCase* const both : {&one, &two})
            if (projection == Projection::parallel) both->volume().isosurfaces = {{0.1, {}}, {-0.2, {1, 0, 0, 1}}};
        EXPECT_TRUE(picture_of(one).pixels == picture_of(two).pixels);
        one.volume().shaded = two.volume().shaded = true;
        EXPECT_TRUE(picture_of(one).pixels == picture_of(two).pixels);
    }
}

TEST(VolumeBytes, AreTheSameOnAnyThreadsAndWithLists) {
    for (const char* shape : {"kuhn", "mixed"}) {
        VolumeCase one = made_volume(shape, 8, "gyroid", two_peaks);
        one.volume().shaded = true;
        one.picture.samples = 1;
        const Surface inside = sheet_at(0.1, 0.3);
        DrawnSurface& drawn = one.scene.surfaces.emplace_back();
        drawn.triangles = &inside;
        drawn.opacity = 0.4;
        const Picture picture = picture_of(one);
        for (const int threads : {2, 7, 64}) EXPECT_TRUE(picture_of(one, threads).pixels == picture.pixels) << threads;
        VolumeWork work, all_work;
        for (const render::VolumeTuning& tuning :
             {render::VolumeTuning{{8, 1}}, {{8, 8}}, {{512, 400}}, {{16, 1000}}, {{128, 64}, false}}) {
            const Picture tuned = render::draw_tuned(one.scene, one.picture, tuning, {.threads = 1}, all_work).value();
            EXPECT_TRUE(tuned.pixels == picture.pixels) << tuning.lists.capacity << " " << tuning.lists.compose_from;
        }
        EXPECT_TRUE(draw(one.scene, one.picture, {}, work));
        EXPECT_GT(all_work.tets, work.tets) << "the last one left nothing out";
        EXPECT_GT(work.segments, 1000U);
        EXPECT_GT(work.clusters, 0U);
        EXPECT_GT(work.bytes, 0U);
    }
}

TEST(VolumeBytes, OfOtherCellsAreThoseOfTheirTets) {
    for (const char* shape : {"hex", "mixed"}) {
        const Grid grid = made_grid(shape, 7, {"gyroid"});
        VolumeCase one = volume_of(grid, point_field(grid), two_peaks);
        one.volume().shaded = true;
        const Picture picture = picture_of(one);
        EXPECT_TRUE(picture_of(volume_of(grid, point_field(grid), two_peaks, {.split_cells = true})).pixels !=
                    picture.pixels)
            << "without shading";
        VolumeCase tets = volume_of(grid, point_field(grid), two_peaks, {.split_cells = true});
        tets.volume().shaded = true;
        EXPECT_TRUE(picture_of(tets).pixels == picture.pixels) << shape;
    }
}

TEST(VolumeBytes, AreTheSameAtEveryLevel) {
    VolumeCase one = made_volume("perturbed", 8, "gyroid", two_peaks);
    one.volume().shaded = true;
    one.volume().isosurfaces = {{-0.1, {}}};
    const Picture picture = picture_of(one);
    for (const core::Level level : {core::Level::portable, core::Level::avx2, core::Level::avx512}) {
        if (level > core::best_level()) continue;
        core::force_level(level);
        EXPECT_TRUE(picture_of(one).pixels == picture.pixels) << core::name_of(level);
    }
    core::force_level({});
}

TEST(VolumeBytes, AreThoseOfAFileOfWhichLittleIsInMemory) {
    const TemporaryFolder folder;
    for (const char* shape : {"kuhn", "mixed"}) {
        VolumeCase one = made_volume(shape, 10, "gyroid", two_peaks);
        one.volume().isosurfaces = {{-0.1, {}}};
        const Picture expected = picture_of(one);
        const std::string path = folder.file(std::string(shape) + ".isotet");
        save_packed(*one.grid, path, {.more_fields = {}, .time = {}, .chunk_bytes = 2'000}).value();
        for (const std::uint64_t memory : {std::uint64_t{1}, std::uint64_t{100'000}, std::uint64_t{1} << 30})
            for (const int threads : {1, 7}) {
                const PackedFile file = PackedFile::open(path, {memory}).value();
                const PackedGrid grid = file.grid().value();
                one.volume().grid = &grid;
                EXPECT_TRUE(picture_of(one, threads).pixels == expected.pixels) << shape << memory << " " << threads;
            }
    }
}

TEST(VolumeBytes, OfAFileThatAreTransparentAreNotRead) {
    const TemporaryFolder folder;
    VolumeCase one = made_volume("kuhn", 20, "plane", {});
    save_packed(*one.grid, folder.file("plane.isotet"), {.more_fields = {}, .time = {}, .chunk_bytes = 2'000}).value();
    const auto bytes_read = [&](const OpacityCurve& opacity) {
        const PackedFile file = PackedFile::open(folder.file("plane.isotet")).value();
        const PackedGrid grid = file.grid().value();
        one.volume().grid = &grid;
        one.volume().opacity = opacity;
        picture_of(one);
        return file.residency().bytes_read;
    };
    EXPECT_LT(bytes_read({{{1.2, 0}, {1.3, 0.9}}}), bytes_read({{{-2, 0.1}, {2, 0.9}}}) / 2);
}

TEST(VolumeBytes, OfATransparentVolumeAreThoseOfTheBackground) {
    VolumeCase one = made_volume("kuhn", 4, "gyroid", {{{-2, 0}, {2, 0}}});
    one.picture.background = {0.2F, 0.4F, 0.6F, 0.5F};
    const Picture picture = picture_of(one);
    one.scene.volumes.clear();
    EXPECT_TRUE(picture_of(one).pixels == picture.pixels);
    // Of values that the field does not have, and of a field without values.
    one = made_volume("kuhn", 4, "gyroid", {{{5, 0}, {6, 1}, {7, 0}}});
    one.picture.background = {0.2F, 0.4F, 0.6F, 0.5F};
    EXPECT_TRUE(picture_of(one).pixels == picture.pixels);
    const Grid grid = made_grid("kuhn", 4, {});
    one = volume_of(grid, field_of(std::vector<float>(grid.points.tuples(), NAN)), {{{0, 1}}});
    one.volume().scale = {};
    one.picture.background = {0.2F, 0.4F, 0.6F, 0.5F};
    EXPECT_TRUE(picture_of(one).pixels == picture.pixels);
}

/// Every tet against one ray, in double, in the order of their beginnings.
class SlowRay {
public:
    SlowRay(const Grid& grid, const PointField& field, const DrawnVolume& volume) : volume_(volume) {
        std::set<std::set<std::uint64_t>> seen;
        for (std::size_t i = 0; i < grid.cells.count(); ++i) {
            Tet tet;
            std::set<std::uint64_t> corners;
            bool known = true;
            for (std::size_t k = 0; k < 4; ++k) {
                const auto point = static_cast<std::size_t>(grid.cells.connectivity.at(4 * i + k));
                corners.insert(point);
                for (std::size_t axis = 0; axis < 3; ++axis) tet.points[k][axis] = grid.points.at(point, axis);
                tet.values[k] = static_cast<double>(field.values.at(point));
                known = known && std::isfinite(tet.values[k]);
            }
            if (known && seen.insert(corners).second) tets_.push_back(tet);
        }
    }

    /// Light and what comes through.
    std::array<double, 4> follow(const UserRay& ray) const {
        std::vector<Part> parts;
        for (const Tet& tet : tets_) add(tet, ray, volume_.clips, parts);
        std::ranges::sort(parts, {}, &Part::begin);
        std::array<double, 4> out{0, 0, 0, 1};
        for (const Part& part : parts) {
            constexpr int steps = 24;
            for (int i = 0; i < steps && out[3] > 0.001; ++i) {
                const double value = part.a + (part.b - part.a) * (i + 0.5) / steps;
                const double depth = render::depth_of(volume_.opacity.at(value)) / volume_.opacity_length;
                const double hidden = 1 - std::exp(-depth * (part.to - part.from) / steps);
                const render::Light color =
                    render::linear_light(color_at(volume_.scale.map, volume_.scale.place_of(value)));
                for (std::size_t k = 0; k < 3; ++k) out[k] += out[3] * hidden * double{color[k]};
                out[3] *= 1 - hidden;
            }
        }
        return out;
    }

private:
    struct Tet {
        std::array<std::array<double, 3>, 4> points;
        std::array<double, 4> values;
    };
    struct Part {
        double from, to, a, b;
        double begin; ///< of the tet, also where it is cut
    };

    /// Barycentric coordinates are linear along the ray.
    static void add(const Tet& tet, const UserRay& ray, const std::vector<Plane>& clips, std::vector<Part>& parts) {
        const auto weights = [&](const std::array<double, 3>& p) {
            std::array<double, 4> out{};
            for (std::size_t k = 0; k < 4; ++k) {
                std::array<std::array<double, 3>, 4> corners = tet.points;
                corners[k] = p;
                out[k] = volume_of_corners(corners);
            }
            return out;
        };
        const double whole = volume_of_corners(tet.points);
        if (std::abs(whole) < 1e-9) return;
        const auto at_0 = weights(ray.at(0)), at_1 = weights(ray.at(1));
        Part part{1e-3, INFINITY, 0, 0, 0};
        for (std::size_t k = 0; k < 4; ++k) {
            const double begin = at_0[k] / whole, slope = (at_1[k] - at_0[k]) / whole;
            if (slope == 0 && begin < 0) return;
            if (slope > 0) part.from = std::max(part.from, -begin / slope);
            if (slope < 0) part.to = std::min(part.to, -begin / slope);
        }
        part.begin = part.from;
        for (const Plane& plane : clips) {
            const auto height = [&](double t) {
                const std::array<double, 3> p = ray.at(t);
                return plane.normal[0] * p[0] + plane.normal[1] * p[1] + plane.normal[2] * p[2] - plane.offset;
            };
            const double slope = height(1) - height(0), end = -height(0) / slope;
            (slope > 0 ? part.to : part.from) = slope > 0 ? std::min(part.to, end) : std::max(part.from, end);
        }
        if (!(part.from < part.to)) return;
        for (std::size_t k = 0; k < 4; ++k) {
            part.a += tet.values[k] * (at_0[k] + part.from * (at_1[k] - at_0[k])) / whole;
            part.b += tet.values[k] * (at_0[k] + part.to * (at_1[k] - at_0[k])) / whole;
        }
        parts.push_back(part);
    }
    static double volume_of_corners(const std::array<std::array<double, 3>, 4>& p) {
        std::array<std::array<double, 3>, 3> e;
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t k = 0; k < 3; ++k) e[i][k] = p[i + 1][k] - p[0][k];
        return e[0][0] * (e[1][1] * e[2][2] - e[1][2] * e[2][1]) - e[0][1] * (e[1][0] * e[2][2] - e[1][2] * e[2][0]) +
               e[0][2] * (e[1][0] * e[2][1] - e[1][1] * e[2][0]);
    }

    const DrawnVolume& volume_;
    std::vector<Tet> tets_;
};

TEST(VolumeBytes, AreThoseOfEveryTetAgainstEveryRay) {
    std::size_t worse = 0, pixels = 0;
    for (const std::uint32_t seed : Seeds(1, 120)) {
        NastyOptions options;
        options.side = 2 + static_cast<int>(seed % 2);
        options.values = seed % 3 == 0 ? 0 : 5;
        options.no_data = seed % 4 == 0 ? 0.05 : 0;
        options.missing = 0.1;
        options.inverted = seed % 2 == 0 ? 0.1 : 0;
        options.mirrored = options.repeated = 0.1;
        const NastyGrid nasty = nasty_grid(seed, options);
        VolumeCase one = volume_of(nasty.grid, nasty.field, {{{-1.2, 0.1}, {0.2, 0.7}, {0.9, 0}, {2, 0.3}}});
        one.picture.width = 12;
        one.picture.height = 9;
        one.look_from(seed * 37.0, 20, seed % 5 == 0 ? Projection::parallel : Projection::perspective);
        if (seed % 3 == 1) one.volume().clips = {{{1, 0.3, 0}, 0.4}, {{0, -1, 2}, 0.8}};
        const RayValues rays = rays_of(one.scene, one.picture);
        const SlowRay slow(nasty.grid, nasty.field, one.volume());
        for (std::uint32_t y = 0; y < 9; ++y)
            for (std::uint32_t x = 0; x < 12; ++x) {
                const std::array<double, 4> expected = slow.follow(user_ray(one.picture, x, y));
                const render::Slab& slab = rays.slabs[std::size_t{y} * 12 + x];
                double error = std::abs(expected[3] - slab.through);
                for (std::size_t k = 0; k < 3; ++k) error = std::max(error, std::abs(expected[k] - slab.light[k]));
                ++pixels;
                worse += error > 0.004 ? 1 : 0;
                EXPECT_LT(error, 0.03) << seed << " " << x << " " << y;
            }
    }
    EXPECT_LE(worse, pixels / 1000) << "of equal beginnings of tets that overlap, another may come first";
}

/// The cube of a homogeneous medium, half opaque a unit of length, seen along x without perspective.
class SheetsInVolume : public ::testing::Test {
protected:
    SheetsInVolume() : one_(made_volume("kuhn", 6, "gyroid", {{{0, 0.5}}})) {
        one_.volume().scale.classes = {{0, 0, 1, 1}};
        one_.picture.background = {1, 1, 1, 1};
        one_.picture.camera = camera_of(View::plus_x, Projection::parallel);
        one_.scene.bounds.add(Box{{-2, -2, -2}, {2, 2, 2}});
        one_.picture.camera.height = 1.6;
        one_.picture.camera.distance = 6;
    }
    DrawnSurface& add(const Surface& surface, double opacity) {
        DrawnSurface& drawn = one_.scene.surfaces.emplace_back();
        drawn.triangles = &surface;
        drawn.opacity = opacity;
        drawn.color = {1, 0, 0, 1};
        return drawn;
    }
    /// Red in linear light: that of the sheet, and of the white background through all.
    void expect_red(double red, std::uint32_t x = 48, std::uint32_t y = 32, int tolerance = 1) {
        const Picture picture = picture_of(one_);
        EXPECT_NEAR(picture.at(x, y)[0], render::LightBytes().of(static_cast<float>(red)), tolerance);
    }
    static double through(double length) { return std::exp2(-length); }

    VolumeCase one_;
};

TEST_F(SheetsInVolume, ATranslucentSheetBeforeInsideAndBehind) {
    for (const double x : {1.5, 0.25, -0.4, -1.7}) {
        const Surface sheet = sheet_at(x);
        one_.scene.surfaces.clear();
        add(sheet, 0.5);
        const double before = std::clamp(1 - x, 0.0, 2.0);
        expect_red(through(before) * 0.5 + 0.5 * through(2));
    }
}

TEST_F(SheetsInVolume, AnOpaqueSheetEndsRays) {
    for (const double x : {1.5, 0.25, -0.4, -1.7}) {
        const Surface sheet = sheet_at(x);
        one_.scene.surfaces.clear();
        add(sheet, 1);
        expect_red(through(std::clamp(1 - x, 0.0, 2.0)));
    }
}

TEST_F(SheetsInVolume, SeveralSheetsAreInOrderWhateverTheirOrderInTheScene) {
    const Surface near = sheet_at(0.5), far = sheet_at(-0.5), behind = sheet_at(-0.7);
    for (const bool turned : {false, true}) {
        one_.scene.surfaces.clear();
        if (turned) add(behind, 1).color = {0, 1, 0, 1};
        add(turned ? far : near, turned ? 0.25 : 0.5);
        add(turned ? near : far, turned ? 0.5 : 0.25);
        if (!turned) add(behind, 1).color = {0, 1, 0, 1};
        expect_red(through(0.5) * 0.5 + through(1.5) * 0.5 * 0.25);
    }
}

TEST_F(SheetsInVolume, ASlantedOpaqueSheetHasNoSteps) {
    const Surface sheet = sheet_at(0, 1.0);
    add(sheet, 1);
    const Picture picture = picture_of(one_);
    for (std::uint32_t y = 1; y < 64; ++y) // deeper downwards, evenly
        EXPECT_NEAR(picture.at(48, y)[0], picture.at(48, y - 1)[0], 4) << y;
    EXPECT_GT(picture.at(48, 2)[0], picture.at(48, 60)[0] + 40);
}

TEST_F(SheetsInVolume, IsosurfacesThatRaysMeetHideWhatIsBehind) {
    const Grid grid = made_grid("kuhn", 6, {"gyroid"});
    VolumeCase plane = volume_of(grid, find_field(grid, "x").value(), {{{0, 0.5}}});
    one_.grid = plane.grid;
    one_.volume().grid = one_.grid.get();
    one_.volume().isosurfaces = {{0.25, {1, 0, 0, 1}}};
    expect_red(through(0.75));
    const Surface sheet = sheet_at(0);
    add(sheet, 0.5).color = {0, 1, 0, 1};
    expect_red(through(0.75));
    const Surface before = sheet_at(0.5);
    add(before, 0.5).color = {0, 1, 0, 1};
    expect_red(0.5 * through(0.75));
}

TEST(VolumeErrors, AreTold) {
    VolumeCase one = made_volume("kuhn", 2, "gyroid", {{{0, 0.5}}});
    const auto message = [&] { return draw(one.scene, one.picture).error().message; };
    one.volume().opacity_length = 0;
    EXPECT_EQ(message(), "the length of the opacity is 0, but it must be positive");
    one.volume().opacity_length = 1;
    one.volume().opacity.points[0].opacity = 2;
    EXPECT_NE(message().find("must be from 0 to 1"), std::string::npos);
    one.volume().opacity.points[0].opacity = 1;
    one.volume().scale.lower = NAN;
    EXPECT_NE(message().find("a colour scale from nan"), std::string::npos);
    one.volume().scale.lower = -2;
    one.volume().isosurfaces = {{INFINITY, {}}};
    EXPECT_NE(message().find("must be finite"), std::string::npos);
    one.volume().isosurfaces.clear();
    const std::atomic<bool> cancel = true;
    EXPECT_EQ(draw(one.scene, one.picture, {.progress = {.report = {}, .cancel = &cancel}}).error().code,
              ErrorCode::cancelled);
    one.volume().grid = nullptr;
    EXPECT_EQ(message(), "a volume without a grid");
    one.scene.volumes.resize(65537);
    EXPECT_NE(message().find("65537 volumes, but at most 65536"), std::string::npos);
}

} // namespace
} // namespace isotet::test
