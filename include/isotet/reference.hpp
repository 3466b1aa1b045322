// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The slow, short versions of extraction, which every engine is held against: for tests, and for those who doubt.
#pragma once

#include <span>
#include <vector>

#include <isotet/contour_spectrum.hpp>
#include <isotet/export.hpp>
#include <isotet/extract.hpp>
#include <isotet/extract_direct.hpp>

namespace isotet {

/// What extract() gives, byte for byte, worked out on one thread without any cleverness.
///
/// Cost     10 to 100 times the time of extract(); memory for a map of all edges of the surface
/// Errors   as extract()
ISOTET_API Result<std::vector<Extraction>> extract_by_reference(const PackedGrid& packed,
                                                                std::span<const double> isovalues,
                                                                const ExtractOptions& options = {},
                                                                const Run& run = {});

/// What extract_direct() gives, byte for byte. Cost and errors as above.
ISOTET_API Result<DirectExtraction> extract_direct_by_reference(const Grid& grid, const PointField& field,
                                                                std::span<const double> isovalues,
                                                                const DirectOptions& options = {}, const Run& run = {});

/// What contour_spectrum() gives within 1e-12 of its largest area and volume, by cutting every tet at every isovalue.
/// Errors   as contour_spectrum()
ISOTET_API Result<ContourSpectrum> contour_spectrum_by_reference(const Grid& grid, const PointField& field,
                                                                 std::span<const double> isovalues,
                                                                 const Run& run = {});

} // namespace isotet
