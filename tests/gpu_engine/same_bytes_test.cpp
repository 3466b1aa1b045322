// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The same bytes as the CPU engine, in both modes for ties: every array, on grids as nasty as those that the CPU engine
// is measured on.
#include "gpu_engine/engines.hpp"
#include "support/close_values.hpp"
#include "support/random_grid.hpp"
#include "support/seeds.hpp"
#include "support/small_grid.hpp"

namespace isotet::test {
namespace {

class SameBytes : public Engines {
protected:
    void expect_same_on(const Grid& grid, const PointField& field, const std::vector<double>& isovalues,
                        const ExtractOptions& options = {}) {
        const PackedGrid packed = pack(grid, field, {.source_cells = true, .gradients = true}).value();
        DeviceGrid on_device = DeviceGrid::upload(device(), packed).value();
        expect_same(on_device, packed, isovalues, options);
    }
    /// Positions and triangles alone, and with every other array.
    void expect_same_on(std::uint32_t seed, const NastyOptions& nasty, const std::vector<double>& isovalues) {
        const NastyGrid g = nasty_grid(seed, nasty);
        expect_same_on(g.grid, g.field, isovalues);
        expect_same_on(g.grid, g.field, isovalues, everything(g));
    }

    static ExtractOptions everything(const NastyGrid& g) {
        std::vector<std::int16_t> numbers(g.grid.cells.count());
        for (std::size_t cell = 0; cell < numbers.size(); ++cell) numbers[cell] = static_cast<std::int16_t>(cell);
        ExtractOptions options;
        options.normals = Normals::gradient;
        options.edge_ends = options.source_cells = true;
        options.point_fields = {{"value", g.field.values}, {"point", g.grid.points}};
        options.cell_fields = {{"number", Array::own(std::move(numbers))}};
        return options;
    }
};

TEST_F(SameBytes, OnSmoothFields) {
    for (const std::uint32_t seed : Seeds(1, 4)) expect_same_on(seed, {.side = 11, .values = 0}, {-2, -0.4, 0, 0.3, 2});
}

TEST_F(SameBytes, OnIntegerFieldsFullOfTies) {
    for (const std::uint32_t seed : Seeds(1, 12))
        expect_same_on(seed, {.side = 4 + int(seed) % 6, .values = 2 + int(seed) % 4}, {-1, 0, 0.5, 1, 2});
}

TEST_F(SameBytes, OnCloseValues) {
    for (const bool far_values : {false, true}) {
        const CloseValues close{.far_values = far_values};
        const Grid grid = made_grid("shuffled", 8, {"gyroid"});
        expect_same_on(grid, close.field(grid), {close.isovalue(2, 0.3), close.isovalue(3, 0)});
    }
}

TEST_F(SameBytes, OnPointsWithoutData) {
    for (const std::uint32_t seed : Seeds(1, 12))
        expect_same_on(seed, {.side = 4 + int(seed) % 6, .values = 4, .no_data = 0.05 * (seed % 5)}, {-1, 0, 1, 1.5});
}

TEST_F(SameBytes, OnTangledGridsWithRepeatedAndMissingTets) {
    for (const std::uint32_t seed : Seeds(1, 12))
        expect_same_on(seed,
                       {.side = 4 + int(seed) % 6,
                        .values = 3,
                        .no_data = 0.03,
                        .missing = 0.2,
                        .inverted = 0.2,
                        .mirrored = 0.5,
                        .repeated = 0.1,
                        .wide = seed % 3 == 0},
                       {0, 0.5, 1});
}

TEST_F(SameBytes, OfNormalsOfFacesAndVertices) {
    for (const std::uint32_t seed : Seeds(1, 3)) {
        const NastyGrid g =
            nasty_grid(seed, {.side = 7, .values = seed == 1 ? 0 : 3, .no_data = 0.02, .inverted = 0.1});
        ExtractOptions options;
        for (const Normals normals : {Normals::face, Normals::vertex}) {
            options.normals = normals;
            expect_same_on(g.grid, g.field, {-0.2, 0, 1}, options);
        }
    }
}

// Where the gradient vanishes the face normal stands in.
TEST_F(SameBytes, OfGradientNormalsThatVanish) {
    for (const std::uint32_t seed : Seeds(1, 4)) {
        NastyGrid g = nasty_grid(seed, {.side = 6, .values = 2});
        ExtractOptions options;
        options.normals = Normals::gradient;
        expect_same_on(g.grid, g.field, {-0.5, 0}, options);
    }
    const Grid flat = made_grid("kuhn", 4, {"plane"});
    std::vector<float> ridge;
    for (std::size_t p = 0; p < flat.points.tuples(); ++p)
        ridge.push_back(static_cast<float>(std::abs(flat.points.at(p, 0))));
    ExtractOptions options;
    options.normals = Normals::gradient;
    expect_same_on(flat, field_of(std::move(ridge)), {0, 0.25, 0.5}, options);
}

TEST_F(SameBytes, OnHexahedraWedgesAndPyramids) {
    for (const char* shape : {"hex", "wedge", "pyramid", "mixed", "layer"}) {
        const Grid grid = made_grid(shape, 7, {"wavelet", "integer"});
        ExtractOptions options;
        options.edge_ends = options.source_cells = true;
        expect_same_on(grid, point_field(grid, 0), {0.1}, options);
        expect_same_on(grid, point_field(grid, 1), {2}, options);
    }
}

} // namespace
} // namespace isotet::test
