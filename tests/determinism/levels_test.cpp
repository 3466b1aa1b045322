// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The same bytes from portable code, AVX2 and AVX-512: as far as the machine goes, which the test prints.
#include <gtest/gtest.h>

#include <isotet/extract.hpp>
#include <isotet/pack.hpp>

#include "cpu/level.hpp"
#include "support/random_grid.hpp"
#include "support/surface_bytes.hpp"

namespace isotet::test {
namespace {

TEST(InstructionLevels, GiveTheSameBytes) {
    RecordProperty("best_level", std::string(cpu::name_of(cpu::best_level())));
    for (std::uint32_t seed = 1; seed <= 6; ++seed) {
        const bool smooth = seed % 2;
        const NastyGrid g = nasty_grid(seed, {.side = 9, .values = smooth ? 0 : 5, .no_data = smooth ? 0 : 0.002, .missing = 0.05});
        const PackedGrid packed = pack(g.grid, g.field, {.source_cells = true, .gradients = true}).value();
        for (const double isovalue : {-0.5, 0.0, 0.25, 1.5})
            for (const bool extras : {false, true}) {
                ExtractOptions options;
                options.edge_ends = options.source_cells = extras;
                options.normals = extras ? Normals::gradient : Normals::none;
                options.engine = Engine::reference;
                const Surface reference = extract(packed, isovalue, options).value().surface;
                options.engine = Engine::cpu;
                for (int level = 0; level <= int(cpu::best_level()); ++level) {
                    cpu::force_level(cpu::Level(level));
                    const Surface surface = extract(packed, isovalue, options).value().surface;
                    cpu::force_level({});
                    ASSERT_TRUE(bytes_of(surface) == bytes_of(reference))
                        << "seed " << seed << ", isovalue " << isovalue << ", " << cpu::name_of(cpu::Level(level));
                }
            }
    }
}

} // namespace
} // namespace isotet::test
