// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The CPU engine and the reference under one name.
#pragma once

#include <span>
#include <vector>

#include <isotet/engine.hpp>

namespace isotet::test {

enum class Engine { cpu, reference };

inline constexpr Engine both_engines[] = {Engine::cpu, Engine::reference};

inline Result<std::vector<Extraction>> extract_on(Engine engine, const PackedGrid& packed,
                                                  std::span<const double> isovalues,
                                                  const ExtractOptions& options = {}, const Run& run = {}) {
    return engine == Engine::cpu ? extract(packed, isovalues, options, run)
                                 : extract_by_reference(packed, isovalues, options, run);
}

inline Result<Extraction> extract_on(Engine engine, const PackedGrid& packed, double isovalue,
                                     const ExtractOptions& options = {}, const Run& run = {}) {
    auto all = extract_on(engine, packed, std::span(&isovalue, 1), options, run);
    if (!all) return all.error();
    return std::move(all->front());
}

inline Result<DirectExtraction> extract_direct_on(Engine engine, const Grid& grid, const PointField& field,
                                                  std::span<const double> isovalues,
                                                  const DirectOptions& options = {}, const Run& run = {}) {
    return engine == Engine::cpu ? extract_direct(grid, field, isovalues, options, run)
                                 : extract_direct_by_reference(grid, field, isovalues, options, run);
}

} // namespace isotet::test
