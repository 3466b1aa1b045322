// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Symmetric tensors of 6 components in VTK's order: XX YY ZZ XY YZ XZ.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <isotet/array.hpp>
#include <isotet/export.hpp>

namespace isotet::io {

/// Where each component, in VTK's order, stands in another one.
using TensorOrder = std::array<std::uint8_t, 6>;

inline constexpr TensorOrder order_of_upper_rows{0, 3, 5, 1, 4, 2}; ///< XX XY XZ YY YZ ZZ
inline constexpr TensorOrder order_of_lower_rows{0, 2, 5, 1, 4, 3}; ///< XX XY YY XZ YZ ZZ

/// The order that names of components state by how they end: XX or xx or 11, and so on. Nothing where it is VTK's, or where
/// they are not those of a symmetric tensor.
ISOTET_API std::optional<TensorOrder> order_of_names(std::span<const std::string> names);

/// Reorders tuples of 6 values of `size` bytes each.
ISOTET_API void order_as_vtk(std::byte* values, std::size_t tuples, std::size_t size, const TensorOrder& from);

template <class T>
void order_as_vtk(std::vector<T>& values, const TensorOrder& from) {
    order_as_vtk(reinterpret_cast<std::byte*>(values.data()), values.size() / from.size(), sizeof(T), from);
}

/// A copy in VTK's order.
ISOTET_API Array ordered_as_vtk(const Array& values, const TensorOrder& from);

} // namespace isotet::io
