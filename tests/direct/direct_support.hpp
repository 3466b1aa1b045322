// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Surfaces from plain arrays against the reference, byte for byte, and against the packed grid: the same vertices and
// triangles, and the same said of field and ties.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <isotet/extract.hpp>

#include "support/brute_weld.hpp"
#include "support/engines.hpp"
#include "support/surface_bytes.hpp"

namespace isotet::test {

inline constexpr double infinity = std::numeric_limits<double>::infinity();

inline DirectOptions with_everything(Ties ties, Precision precision) {
    DirectOptions options;
    options.precision = precision;
    options.extract.ties = ties;
    options.extract.normals = Normals::gradient;
    options.extract.edge_ends = options.extract.source_cells = true;
    return options;
}

inline void expect_same_report(const FieldReport& found, const FieldReport& wanted) {
    EXPECT_EQ(found.name, wanted.name);
    EXPECT_EQ(found.lower, wanted.lower);
    EXPECT_EQ(found.upper, wanted.upper);
    EXPECT_EQ(found.no_data, wanted.no_data);
    EXPECT_EQ(found.infinite, wanted.infinite);
    EXPECT_EQ(found.flushed, wanted.flushed);
    EXPECT_EQ(found.offset, wanted.offset);
    EXPECT_EQ(found.scale, wanted.scale);
    EXPECT_EQ(found.unchanged, wanted.unchanged);
}

inline void expect_same_report(const ExtractReport& found, const ExtractReport& wanted) {
    EXPECT_EQ(found.tied_points, wanted.tied_points);
    EXPECT_EQ(found.false_ties, wanted.false_ties);
    EXPECT_EQ(found.near_tie, wanted.near_tie);
    EXPECT_EQ(found.isovalue_stored, wanted.isovalue_stored);
}

/// Both engines: the same bytes, the same reports. Returns what the CPU engine gave.
inline DirectExtraction extract_on_both(const Grid& grid, const PointField& field, const std::vector<double>& isovalues,
                                        const DirectOptions& options) {
    DirectExtraction cpu = extract_direct(grid, field, isovalues, options).value();
    const DirectExtraction reference = extract_direct_by_reference(grid, field, isovalues, options).value();
    EXPECT_EQ(cpu.surfaces.size(), isovalues.size());
    for (std::size_t i = 0; i < isovalues.size(); ++i) {
        SCOPED_TRACE(testing::Message() << "isovalue " << isovalues[i] << ", ties " << int(options.extract.ties));
        const Extraction &a = cpu.surfaces[i], &b = reference.surfaces[i];
        EXPECT_EQ(a.surface.vertex_count(), b.surface.vertex_count());
        EXPECT_EQ(a.surface.triangle_count(), b.surface.triangle_count());
        EXPECT_TRUE(bytes_of(a.surface) == bytes_of(b.surface));
        expect_same_report(a.report, b.report);
    }
    expect_same_report(cpu.field, reference.field);
    EXPECT_EQ(cpu.cells_left_out, reference.cells_left_out);
    EXPECT_EQ(cpu.coarse_tets, reference.coarse_tets);
    return cpu;
}

/// Triangles of repeated tets stand once.
inline SurfaceSets without_repeats(SurfaceSets sets, const Grid& grid) {
    std::set<std::int64_t> first_cells;
    for (const UprightTet& tet : upright_tets(grid)) first_cells.insert(tet.cell);
    std::erase_if(sets.cells, [&](const auto& cell) { return !first_cells.contains(cell.first); });
    return sets;
}

/// The packed grid gives the same surfaces in another order, and tells the same.
inline void expect_surfaces_of_clusters(const Grid& grid, const PointField& field, const std::vector<double>& isovalues,
                                        const DirectOptions& options, const DirectExtraction& once) {
    PackOptions pack_options;
    pack_options.precision = options.precision;
    pack_options.source_cells = pack_options.gradients = true;
    const PackedGrid packed = pack(grid, field, pack_options).value();
    expect_same_report(once.field, packed.field());
    EXPECT_EQ(once.cells_left_out, packed.report().cells_left_out);
    for (std::size_t i = 0; i < isovalues.size(); ++i) {
        SCOPED_TRACE(testing::Message() << "isovalue " << isovalues[i] << ", ties " << int(options.extract.ties));
        const Extraction clusters = extract(packed, isovalues[i], options.extract).value();
        const Surface& surface = once.surfaces[i].surface;
        EXPECT_EQ(without_repeats(sets_of(surface), grid), sets_of(clusters.surface));
        expect_same_report(once.surfaces[i].report, clusters.report);
        for (std::size_t f = 0; f < surface.point_fields.size(); ++f)
            EXPECT_EQ(surface.point_fields[f].values.type(), clusters.surface.point_fields[f].values.type());
    }
}

inline void expect_agreement(const Grid& grid, const PointField& field, const std::vector<double>& isovalues,
                             Precision precision = Precision::float32, const std::vector<Field>& carried = {}) {
    for (const Ties ties : {Ties::merge, Ties::keep}) {
        DirectOptions options = with_everything(ties, precision);
        options.extract.point_fields = carried;
        expect_surfaces_of_clusters(grid, field, isovalues, options, extract_on_both(grid, field, isovalues, options));
    }
}

/// The surface of one isovalue from the CPU engine.
inline Surface surface_once(const Grid& grid, const PointField& field, double isovalue, const DirectOptions& options,
                            const Run& run = {}) {
    return extract_direct(grid, field, std::span(&isovalue, 1), options, run).value().surfaces.at(0).surface;
}

} // namespace isotet::test
