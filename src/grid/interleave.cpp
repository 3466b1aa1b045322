// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <cstring>
#include <limits>
#include <memory>
#include <new>

#include <fmt/core.h>

#include <isotet/grid.hpp>

#include "base/buffer.hpp"
#include "base/carry_out.hpp"
#include "base/errors.hpp"
#include "base/parallel.hpp"

namespace isotet {

namespace {

constexpr std::size_t row_grain = 1 << 15;

/// `Word` has the size of a scalar. Scalars may lie at odd places.
template <class Word>
core::Buffer<Word> gathered(std::span<const StridedScalars> columns, std::size_t rows) {
    if (rows > std::numeric_limits<std::size_t>::max() / columns.size()) throw std::bad_array_new_length();
    core::Buffer<Word> words(rows * columns.size());
    core::parallel_ranges(rows, row_grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t column = 0; column < columns.size(); ++column) {
            const auto* from = static_cast<const std::byte*>(columns[column].first) +
                               static_cast<std::ptrdiff_t>(begin) * columns[column].stride;
            Word* to = words.data() + begin * columns.size() + column;
            for (std::size_t row = begin; row < end; ++row, to += columns.size(), from += columns[column].stride)
                std::memcpy(to, from, sizeof(Word));
        }
    });
    return words;
}

template <class Word>
Array array_of_words(std::span<const StridedScalars> columns, std::size_t rows) {
    const Array words = gathered<Word>(columns, rows).to_array(columns.size());
    auto owner = std::make_shared<const Array>(words);
    return Array(columns.front().type, words.data(), rows, columns.size(), std::move(owner));
}

} // namespace

Result<Array> interleave(std::span<const StridedScalars> columns, std::size_t rows, const Run& run) {
    return core::carry_out("interleaving an array", run, [&](const Progress&) -> Result<Array> {
        if (columns.empty()) return invalid_argument("there are no columns to interleave");
        for (std::size_t i = 0; i < columns.size(); ++i) {
            if (columns[i].type != columns.front().type)
                return invalid_argument(fmt::format("column {} is {}, but column 0 is {}", i, name_of(columns[i].type),
                                                    name_of(columns.front().type)));
            if (!columns[i].first && rows > 0) return invalid_argument(fmt::format("column {} is null", i));
        }
        switch (size_of(columns.front().type)) {
        case 1: return array_of_words<std::uint8_t>(columns, rows);
        case 2: return array_of_words<std::uint16_t>(columns, rows);
        case 4: return array_of_words<std::uint32_t>(columns, rows);
        default: return array_of_words<std::uint64_t>(columns, rows);
        }
    });
}

} // namespace isotet
