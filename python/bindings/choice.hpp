// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Words of Python for enums of the library.
#pragma once

#include <nanobind/nanobind.h>

#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <isotet/array.hpp>
#include <isotet/contour.hpp>
#include <isotet/write.hpp>

namespace isotet::python {

template <class Enum, std::size_t N>
using Words = std::pair<std::string_view, Enum>[N];

/// The enum of a word; ValueError names the words that there are.
template <class Enum, std::size_t N>
Enum choice(const char* what, std::string_view word, const Words<Enum, N>& words) {
    std::string known;
    for (const auto& [name, value] : words) {
        if (word == name) return value;
        known += (known.empty() ? "" : ", ") + std::string(name);
    }
    throw nanobind::value_error(
        (std::string(what) + " is '" + std::string(word) + "', but must be one of: " + known).c_str());
}

template <class Enum, std::size_t N>
std::string_view word_of(Enum value, const Words<Enum, N>& words) {
    for (const auto& [name, known] : words)
        if (known == value) return name;
    return {};
}

inline constexpr Words<Compression, 3> words_of_compression{
    {"none", Compression::none}, {"zlib", Compression::zlib}, {"lz4", Compression::lz4}};

inline constexpr Words<Normals, 4> words_of_normals{
    {"none", Normals::none}, {"gradient", Normals::gradient}, {"face", Normals::face}, {"vertex", Normals::vertex}};
inline constexpr Words<Ties, 2> words_of_ties{{"merge", Ties::merge}, {"keep", Ties::keep}};
inline constexpr Words<Precision, 2> words_of_precision{{"float32", Precision::float32},
                                                        {"float64", Precision::float64}};
inline constexpr Words<Method, 2> words_of_method{{"direct", Method::direct}, {"clusters", Method::clusters}};
inline constexpr Words<ContourUpdate, 4> words_of_update{{"nothing", ContourUpdate::nothing},
                                                         {"field", ContourUpdate::field},
                                                         {"points", ContourUpdate::points},
                                                         {"grid", ContourUpdate::grid}};

} // namespace isotet::python
