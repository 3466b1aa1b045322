// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/files/scalars.hpp"

#include <type_traits>
#include <vector>

namespace isotet::io {

std::vector<std::uint64_t> as_indices(const Array& array) {
    return array.visit([](auto values) {
        using Scalar = std::remove_const_t<typename decltype(values)::element_type>;
        if constexpr (std::is_integral_v<Scalar>) return std::vector<std::uint64_t>(values.begin(), values.end());
        else return std::vector<std::uint64_t>();
    });
}

} // namespace isotet::io
