// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Indices of 64 bits as int32, where all of them fit: half the memory, and half the bytes for all that looks at them.
#pragma once

#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>

#include <isotet/array.hpp>

#include "base/buffer.hpp"

namespace isotet::io {

/// Threads   add() is safe from many threads for different places
class NarrowIndices {
public:
    explicit NarrowIndices(std::size_t count) : values_(count) {}

    /// Whether indices of this type become narrower.
    static bool narrows(ScalarType type) noexcept { return type == ScalarType::int64 || type == ScalarType::uint64; }

    /// Takes the indices of the places from `first` on. Negative ones do not fit.
    template <class Index>
    void add(std::size_t first, std::span<const Index> indices) {
        std::uint64_t high = 0;
        std::int32_t* const to = values_.data() + first;
        for (std::size_t i = 0; i < indices.size(); ++i) {
            high |= static_cast<std::uint64_t>(indices[i]) >> 31U;
            to[i] = static_cast<std::int32_t>(indices[i]);
        }
        if (high != 0) fit_ = false;
    }

    /// The same of indices of 64 bits as big endian files have them.
    void add_big_endian(std::size_t first, std::span<const std::byte> indices) {
        std::uint64_t high = 0;
        std::int32_t* const to = values_.data() + first;
        for (std::size_t i = 0; i < indices.size() / sizeof(std::uint64_t); ++i) {
            std::uint64_t index;
            std::memcpy(&index, indices.data() + i * sizeof index, sizeof index);
            if constexpr (std::endian::native == std::endian::little) index = __builtin_bswap64(index);
            high |= index >> 31U;
            to[i] = static_cast<std::int32_t>(index);
        }
        if (high != 0) fit_ = false;
    }

    /// Nothing when one did not fit.
    std::optional<Array> to_array(std::size_t components = 1) && {
        if (!fit_) return std::nullopt;
        return std::move(values_).to_array(components);
    }

private:
    core::Buffer<std::int32_t> values_;
    std::atomic<bool> fit_ = true;
};

} // namespace isotet::io
