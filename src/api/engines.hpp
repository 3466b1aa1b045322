// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Engines that work on the grid where it lies: two functions each.
#pragma once

#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include <isotet/engine.hpp>

namespace isotet::api {

using ExtractPacked = Result<std::vector<Extraction>> (*)(const PackedGrid&, std::span<const double>,
                                                          const ExtractOptions&, const Run&);
using ExtractDirect = Result<DirectExtraction> (*)(const Grid&, const PointField&, std::span<const double>,
                                                   const DirectOptions&, const Run&);

enum class Kernels : bool { cpu, reference };

/// The public functions, by either.
template <Kernels kernels>
Result<std::vector<Extraction>> extract_by(const PackedGrid& packed, std::span<const double> isovalues,
                                           const ExtractOptions& options, const Run& run);
template <Kernels kernels>
Result<DirectExtraction> extract_direct_by(const Grid& grid, const PointField& field, std::span<const double> isovalues,
                                           const DirectOptions& options, const Run& run);

/// `name`   a literal
std::shared_ptr<const Engine> engine_in_memory(std::string_view name, ExtractPacked packed, ExtractDirect direct);

} // namespace isotet::api
