// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Any cells on any points: a grid is refused with an error, or packs, extracts alike on both engines, and gives a
// surface in which nothing is to blame.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <vector>

#include <isotet/check.hpp>
#include <isotet/extract.hpp>
#include <isotet/pack.hpp>

#include "support/engines.hpp"
#include "support/surface_bytes.hpp"

namespace {

using namespace isotet;

/// The fuzzer's bytes one after another; 0 when they have run out.
class Bytes {
public:
    Bytes(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}
    std::uint8_t next() { return at_ < size_ ? data_[at_++] : 0; }
    bool left() const { return at_ < size_; }

private:
    const std::uint8_t* data_;
    std::size_t size_, at_ = 0;
};

float some_value(std::uint8_t byte) {
    switch (byte) {
    case 255: return std::numeric_limits<float>::quiet_NaN();
    case 254: return std::numeric_limits<float>::infinity();
    case 253: return -std::numeric_limits<float>::infinity();
    case 252: return std::numeric_limits<float>::denorm_min();
    case 251: return -0.0f;
    case 250: return std::numeric_limits<float>::max();
    default: return static_cast<float>(byte % 16) / 4 - 1;
    }
}

Grid some_grid(Bytes& bytes) {
    Grid grid;
    const std::size_t points = 4 + bytes.next() % 40;
    const bool may_be_out_of_range = bytes.next() == 7;
    std::vector<float> coordinates(3 * points), values(points);
    for (float& x : coordinates) {
        const std::uint8_t byte = bytes.next();
        x = byte == 255 ? some_value(bytes.next()) : static_cast<float>(byte % 64) / 8;
    }
    for (float& v : values) v = some_value(bytes.next());
    std::vector<std::uint8_t> types;
    std::vector<std::int32_t> offsets{0}, connectivity;
    while (bytes.left() && types.size() < 200) {
        static constexpr std::uint8_t kinds[] = {10, 10, 10, 10, 11, 12, 13, 14, 5, 9};
        static constexpr int corners[] = {4, 4, 4, 4, 8, 8, 6, 5, 3, 4};
        const std::size_t kind = bytes.next() % 10;
        types.push_back(kinds[kind]);
        for (int k = 0; k < corners[kind]; ++k) {
            const std::uint8_t byte = bytes.next();
            connectivity.push_back(may_be_out_of_range ? static_cast<std::int8_t>(byte)
                                                       : static_cast<int>(byte % points));
        }
        offsets.push_back(static_cast<std::int32_t>(connectivity.size()));
    }
    grid.points = Array::own(std::move(coordinates), 3);
    grid.cells = {Array::own(std::move(connectivity)), Array::own(std::move(offsets)), Array::own(std::move(types))};
    grid.point_fields = {{"value", Array::own(std::move(values))}};
    return grid;
}

void expect(bool true_) {
    if (!true_) std::abort();
}

void extract_and_check(const Grid& grid, const PointField& field, const PackedGrid& packed, double isovalue,
                       Ties ties) {
    ExtractOptions options;
    options.ties = ties;
    options.edge_ends = true;
    options.normals = Normals::gradient;
    const auto surface = extract(packed, isovalue, options, {.threads = 1});
    const auto reference = test::extract_on(test::Engine::reference, packed, isovalue, options, {.threads = 1});
    expect(surface && reference);
    expect(test::bytes_of(surface->surface) == test::bytes_of(reference->surface));
    const auto report = check(surface->surface, {.grid = &grid, .field = &field});
    // Whole cells that lie in each other may give the same triangle.
    expect(report && report->blamed_edges == 0 && (ties == Ties::keep || report->equal_corner_triangles == 0));
}

/// From the arrays alone: both engines give the same bytes, as many vertices as the packed grid, and the same refusal.
void expect_same_once(const Grid& grid, const PointField& field, const Result<PackedGrid>& packed, double isovalue,
                      Precision precision, Ties ties) {
    DirectOptions options;
    options.precision = precision;
    options.extract.ties = ties;
    options.extract.edge_ends = true;
    options.extract.normals = Normals::gradient;
    const Run run{.threads = 1};
    const auto once = extract_direct(grid, field, std::span(&isovalue, 1), options, run);
    const auto reference = extract_direct_by_reference(grid, field, std::span(&isovalue, 1), options, run);
    expect(bool(once) == bool(packed) && bool(reference) == bool(packed));
    if (!packed) {
        // Of a grid that is too small and broken, too, each tells what it finds first.
        const auto is_small = [](const Error& error) { return error.message.find("smaller unit") != std::string::npos; };
        if (is_small(once.error()) || is_small(packed.error()) || is_small(reference.error())) return;
        expect(once.error().message == packed.error().message && reference.error().message == packed.error().message);
        return;
    }
    const Extraction &a = once->surfaces[0], &b = reference->surfaces[0];
    expect(test::bytes_of(a.surface) == test::bytes_of(b.surface));
    const auto clusters = extract(*packed, isovalue, options.extract, run);
    expect(clusters && clusters->surface.vertex_count() == a.surface.vertex_count() &&
           clusters->report.tied_points == a.report.tied_points);
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    Bytes bytes(data, size);
    const double isovalue = some_value(bytes.next());
    const auto precision = bytes.next() % 4 ? Precision::float32 : Precision::float64;
    const Grid grid = some_grid(bytes);
    const PointField field{"value", grid.point_fields[0].values, false, {}};
    const auto report = survey(grid, {.faces = true}, {.threads = 1});
    const auto packed = pack(grid, field, {.precision = precision, .gradients = true}, {.threads = 1});
    // A survey takes grids without tets, or so small that coordinates would vanish; packing does not.
    expect(report ? packed || report->tets == 0 || packed.error().message.find("smaller unit") != std::string::npos
                  : !packed);
    if (std::isfinite(isovalue))
        for (const Ties ties : {Ties::merge, Ties::keep})
            expect_same_once(grid, field, packed, isovalue, precision, ties);
    if (!packed) {
        expect(packed.error().code == ErrorCode::invalid_data && !packed.error().message.empty());
        return 0;
    }
    const auto split_up = pack(grid, field, {.precision = precision, .split_cells = true}, {.threads = 1});
    expect(split_up && split_up->report().tets == report->tets - report->repeated_tets);
    if (!std::isfinite(isovalue)) return 0;
    for (const Ties ties : {Ties::merge, Ties::keep}) extract_and_check(grid, field, *packed, isovalue, ties);
    return 0;
}
