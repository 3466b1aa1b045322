// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/array.hpp>

namespace isotet {

std::size_t size_of(ScalarType type) noexcept {
    switch (type) {
    case ScalarType::int8:
    case ScalarType::uint8: return 1;
    case ScalarType::int16:
    case ScalarType::uint16: return 2;
    case ScalarType::int32:
    case ScalarType::uint32:
    case ScalarType::float32: return 4;
    case ScalarType::int64:
    case ScalarType::uint64:
    case ScalarType::float64: break;
    }
    return 8;
}

std::string_view name_of(ScalarType type) noexcept {
    constexpr std::string_view names[] = {"int8",   "uint8", "int16",  "uint16",  "int32",
                                          "uint32", "int64", "uint64", "float32", "float64"};
    return names[static_cast<std::size_t>(type)];
}

double Array::at(std::size_t tuple, std::size_t component) const noexcept {
    return visit([&](auto values) { return static_cast<double>(values[tuple * components_ + component]); });
}

} // namespace isotet
