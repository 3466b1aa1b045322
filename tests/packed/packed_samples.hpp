// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Small packed grids of all kinds, and the same from files.
#pragma once

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <isotet/extract.hpp>
#include <isotet/packed_file.hpp>

#include "determinism/packed_bytes.hpp"
#include "support/mixed_grid.hpp"
#include "support/random_grid.hpp"
#include "support/small_grid.hpp"
#include "support/surface_bytes.hpp"
#include "support/temporary_folder.hpp"

namespace isotet::test {

struct PackedSample {
    std::string name;
    PackedGrid packed;
    std::vector<double> isovalues;
};

inline PackOptions packing_of_all(Precision precision) {
    PackOptions options;
    options.precision = precision;
    options.source_cells = options.gradients = true;
    return options;
}

/// Tets and other cells; ties, no data, values that are scaled, points of both types; in both precisions.
inline std::vector<PackedSample> packed_samples(int side = 7) {
    std::vector<PackedSample> samples;
    for (const Precision precision : {Precision::float32, Precision::float64}) {
        const std::string suffix = precision == Precision::float32 ? " single" : " double";
        const PackOptions options = packing_of_all(precision);
        const auto add = [&](const std::string& name, const NastyGrid& nasty, std::vector<double> isovalues) {
            samples.push_back({name + suffix, pack(nasty.grid, nasty.field, options).value(), std::move(isovalues)});
        };
        NastyOptions tets;
        tets.side = side;
        tets.no_data = 0.05;
        tets.missing = 0.1;
        tets.repeated = 0.1;
        add("integer ties", nasty_grid(1, tets), {1, 2, 1.5});
        tets.values = 0;
        tets.wide = true;
        add("smooth", nasty_grid(2, tets), {0, 0.3});
        MixedOptions mixed;
        mixed.side = side - 2;
        mixed.no_data = 0.03;
        add("mixed ties", mixed_grid(3, mixed), {1, 2.5});
        mixed.values = 0;
        mixed.wide = true;
        add("mixed", mixed_grid(4, mixed), {0.1});
        Grid hexahedra = made_grid("hex", static_cast<std::uint64_t>(side), {"gyroid"});
        samples.push_back({"hex" + suffix, pack(hexahedra, point_field(hexahedra), options).value(), {0}});
    }
    Grid far = made_grid("kuhn", static_cast<std::uint64_t>(side), {"gyroid"});
    std::vector<double> values;
    for (std::size_t i = 0; i < far.points.tuples(); ++i) values.push_back(1e6 + 1e-3 * far.point_fields[0].values.at(i));
    samples.push_back({"rounded values", pack(far, field_of(values), packing_of_all(Precision::float32)).value(), {1e6}});
    return samples;
}

/// Chunks of few clusters.
inline std::string saved(const PackedGrid& packed, const TemporaryFolder& folder, std::uint32_t chunk_bytes = 2'000,
                         std::vector<PackedGrid> more_fields = {}) {
    std::string path = folder.file("grid.isotet");
    SavePackedOptions options;
    options.chunk_bytes = chunk_bytes;
    options.more_fields = std::move(more_fields);
    save_packed(packed, path, options).value();
    return path;
}

inline ExtractOptions with_all(Ties ties) {
    ExtractOptions options;
    options.ties = ties;
    options.normals = Normals::gradient;
    options.edge_ends = options.source_cells = true;
    return options;
}

} // namespace isotet::test
