// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "grid/cell/linear_names.hpp"

#include <algorithm>
#include <atomic>
#include <span>
#include <utility>

#include "base/buffer.hpp"
#include "base/parallel.hpp"
#include "grid/cells.hpp"

namespace isotet::core {

namespace {

constexpr std::size_t names_grain = 1 << 18;

bool has_fitting_arrays(const Cells& cells) {
    const ScalarType type = cells.offsets.type();
    const bool whole = type == ScalarType::int32 || type == ScalarType::uint32 || type == ScalarType::int64 ||
                       type == ScalarType::uint64;
    return !cells.types.empty() && cells.types.type() == ScalarType::uint8 && whole &&
           cells.offsets.tuples() == cells.types.tuples() + 1;
}

std::optional<std::uint8_t> linear_name_at(std::span<const std::uint8_t> types, const IndexColumn& offsets,
                                           std::size_t cell) {
    if (types[cell] < first_lagrange) return std::nullopt;
    return linear_name_of(types[cell], offsets[cell + 1] - offsets[cell]);
}

} // namespace

bool has_linear_names(const Cells& cells) {
    if (!has_fitting_arrays(cells)) return false;
    const auto types = cells.types.as<std::uint8_t>();
    const IndexColumn offsets(cells.offsets);
    std::atomic<bool> found{false};
    parallel_ranges(types.size(), names_grain, [&](std::size_t begin, std::size_t end) {
        const auto part = types.subspan(begin, end - begin);
        if (found.load(std::memory_order_relaxed) || *std::ranges::max_element(part) < first_lagrange) return;
        for (std::size_t cell = begin; cell < end; ++cell)
            if (linear_name_at(types, offsets, cell)) {
                found.store(true, std::memory_order_relaxed);
                return;
            }
    });
    return found;
}

Cells with_linear_names(Cells cells) {
    if (!has_linear_names(cells)) return cells;
    const auto types = cells.types.as<std::uint8_t>();
    const IndexColumn offsets(cells.offsets);
    Buffer<std::uint8_t> named(types.size());
    parallel_each(types.size(), names_grain,
                  [&](std::size_t cell) { named[cell] = linear_name_at(types, offsets, cell).value_or(types[cell]); });
    cells.types = std::move(named).to_array();
    return cells;
}

} // namespace isotet::core
