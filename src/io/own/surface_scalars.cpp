// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/own/surface_scalars.hpp"

#include <cstring>
#include <type_traits>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "io/own/pace.hpp"
#include "io/own/write_stream.hpp"

namespace isotet::io {

std::optional<std::size_t> bytes_needed(ScalarType type, std::uint64_t tuples, std::uint64_t components,
                                        std::size_t available) {
    if (tuples == 0 || components == 0) return 0;
    if (components > available / size_of(type) || tuples > available / (components * size_of(type)))
        return std::nullopt;
    return static_cast<std::size_t>(tuples * components * size_of(type));
}

Array decode_scalars(ScalarType type, std::string_view bytes, std::size_t components, std::endian order) {
    return with_type(type, [&](auto zero) {
        using Scalar = decltype(zero);
        std::vector<Scalar> values(bytes.size() / sizeof(Scalar));
        if (!values.empty()) std::memcpy(values.data(), bytes.data(), values.size() * sizeof(Scalar));
        if (order != std::endian::native) {
            swap_bytes(reinterpret_cast<std::byte*>(values.data()), values.size(), sizeof(Scalar));
        }
        return Array::own(std::move(values), components);
    });
}

Result<Array> scan_scalars(TextScanner& scanner, ScalarType type, std::uint64_t tuples, std::uint64_t components,
                           std::string_view what, const Progress& progress) {
    // A number takes a digit and a space: so many must be there before memory is taken.
    const std::size_t most = scanner.left() / 2 + 1;
    if (tuples != 0 && components != 0 && (components > most || tuples > most / components)) {
        return Error{ErrorCode::invalid_data,
                     fmt::format("{}: {} x {} numbers were announced, but only {} bytes are left", what, tuples,
                                 components, scanner.left())};
    }
    return with_type(type, [&](auto zero) -> Result<Array> {
        using Scalar = decltype(zero);
        std::vector<Scalar> values(static_cast<std::size_t>(tuples * components));
        Pace pace(progress, scanner.position() + scanner.left());
        for (std::size_t i = 0; i < values.size(); ++i) {
            if (!read_scalar(scanner, values[i])) {
                return Error{ErrorCode::invalid_data, fmt::format("{}: {} is not {} number {} of {}", what,
                                                                  scanner.where(), name_of(type), i, values.size())};
            }
            if (!pace.goes_on(scanner.position())) return Pace::cancelled();
        }
        return Array::own(std::move(values), static_cast<std::size_t>(components ? components : 1));
    });
}

std::vector<std::uint64_t> as_indices(const Array& array) {
    return array.visit([](auto values) {
        using Scalar = std::remove_const_t<typename decltype(values)::element_type>;
        if constexpr (std::is_integral_v<Scalar>) return std::vector<std::uint64_t>(values.begin(), values.end());
        else return std::vector<std::uint64_t>();
    });
}

} // namespace isotet::io
