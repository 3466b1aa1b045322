// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Cells of one linear kind, one after another: then neither types nor offsets say anything.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <optional>

#include <isotet/export.hpp>
#include <isotet/grid.hpp>

#include "base/parallel.hpp"

namespace isotet::io::vtk_xml {

constexpr std::size_t values_at_once = std::size_t{1} << 16; ///< of an array that is gone through in parallel

/// Corners of a tetrahedron, voxel, hexahedron, wedge or pyramid; nothing for other types.
std::optional<std::uint64_t> corners_of_uniform(std::uint8_t type);

/// Calls test(first index, values) on pieces of an array, in parallel; true if all say true.
template <class Test>
bool all_pieces(const Array& array, const Test& test) {
    std::atomic<bool> all = true;
    array.visit([&](auto values) {
        core::parallel_ranges(values.size(), values_at_once, [&](std::size_t begin, std::size_t end) {
            if (all && !test(std::uint64_t{begin}, values.subspan(begin, end - begin))) all = false;
        });
    });
    return all;
}

/// True if offsets[i] is (first + i + 1) * corners for all of them.
template <class Offsets>
bool are_regular(std::uint64_t first, Offsets offsets, std::uint64_t corners) {
    std::uint64_t wrong = 0;
    for (std::size_t i = 0; i < offsets.size(); ++i)
        wrong |= static_cast<std::uint64_t>(offsets[i]) ^ ((first + i + 1) * corners);
    return wrong == 0;
}

/// Takes types and offsets away where they say nothing.
ISOTET_API void simplify(Cells& cells);

} // namespace isotet::io::vtk_xml
