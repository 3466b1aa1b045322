// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// NumPy arrays in and out, without a copy. Which Python objects become which arrays is decided in isotet/_arrays.py.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <string>
#include <utility>
#include <vector>

#include <isotet/array.hpp>

namespace isotet::python {

namespace nb = nanobind;

/// A contiguous array of a type that isotet has: any other is a TypeError.
using ArrayIn = nb::ndarray<nb::ro, nb::c_contig, nb::device::cpu>;

/// Names and arrays, in order.
using FieldsIn = std::vector<std::pair<std::string, ArrayIn>>;

/// Shares the memory of a Python object, which lives at least as long as the Array. Rows of a two-dimensional array are
/// tuples, of at least one component: else a ValueError.
Array array_in(const ArrayIn& array);

/// The same array with another owner, where Python owns it and may have changed it in place: whoever knows arrays by their
/// owners then looks at what it holds.
Array renewed(const Array& array);

std::vector<Field> fields_in(const FieldsIn& fields);

/// A read-only NumPy array on the memory of `array`, which it keeps alive. One dimension where there is one component.
nb::object array_out(const Array& array);

nb::dict fields_out(const std::vector<Field>& fields);

} // namespace isotet::python
