// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Topologies of XDMF.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include <isotet/array.hpp>
#include <isotet/grid.hpp>
#include <isotet/result.hpp>

namespace isotet::io::confined {

/// A type of elements of XDMF.
struct XdmfElement {
    std::string_view name;
    int code;          ///< in mixed topologies
    std::uint8_t type; ///< VTK's
    unsigned corners;  ///< 0: stated
};

constexpr std::uint8_t xdmf_polyhedron = 42; ///< VTK's type; its corners are a stream of faces

/// Nothing for a name that is not known.
const XdmfElement* xdmf_element(std::string_view name);

/// Indices as integers of 32 or 64 bits, less a base. Some writers store them as floating-point numbers, others in 8 or
/// 16 bits; what is no index becomes -1.
Array xdmf_indices(const Array& values, std::int64_t base);

/// Elements of one type. `order`: for each corner its place in the file; empty: as there.
///
/// Errors   invalid_data: numbers that are no multiple of the corners
Result<Cells> uniform_elements(const XdmfElement& element, std::uint64_t corners, const Array& values,
                               std::int64_t base, std::span<const std::uint64_t> order);

/// Code of the type, for some types the number of corners, then the corners; of a polyhedron the number of its faces, then
/// for each face the number of its points and these.
///
/// `count`   how many there are; nothing: as many as the numbers make
/// Errors   invalid_data: codes that are not known, numbers that end too early or too late
Result<Cells> mixed_elements(const Array& values, std::optional<std::uint64_t> count, std::uint64_t points,
                             std::int64_t base);

/// Polyhedra without codes, or with them.
Result<Cells> polyhedral_elements(const Array& values, std::optional<std::uint64_t> count, std::uint64_t points,
                                  std::int64_t base);

} // namespace isotet::io::confined
