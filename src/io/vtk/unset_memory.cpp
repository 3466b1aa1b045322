// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/vtk/unset_memory.hpp"

#include <cstring>
#include <optional>
#include <malloc.h>

#include <fmt/core.h>

#include "io/own/escape.hpp"

namespace isotet::io::vtk {
namespace {

constexpr unsigned char mark = 0xF5; // float32 -6.2e32, float64 -1.6e260

/// The first tuple with a number of marks alone. Of numbers narrower than four bytes all values are sensible.
std::optional<std::size_t> first_unset(const Array& array) {
    const std::size_t size = size_of(array.type());
    if (size < 4) return std::nullopt;
    unsigned char unset[8];
    std::memset(unset, mark, sizeof unset);
    const auto* bytes = static_cast<const unsigned char*>(array.data());
    for (std::size_t i = 0; i < array.size(); ++i)
        if (std::memcmp(bytes + i * size, unset, size) == 0) return i / array.components();
    return std::nullopt;
}

} // namespace

MarkedMemory::MarkedMemory() { ::mallopt(M_PERTURB, static_cast<unsigned char>(~mark)); }
MarkedMemory::~MarkedMemory() { ::mallopt(M_PERTURB, 0); }

Result<void> MarkedMemory::check(const std::string& path, const Loaded& loaded) {
    const auto look = [&](const std::string& name, const Array& array) -> Result<void> {
        if (const auto tuple = first_unset(array))
            return broken(path, fmt::format("\"{}\" has no value at {}: the file holds fewer than its header says",
                                            escaped(name), *tuple));
        return {};
    };
    for (const Piece& piece : loaded.pieces) {
        if (auto set = look("coordinates of " + piece.name, piece.grid.points); !set) return set;
        for (const auto* fields : {&piece.grid.point_fields, &piece.grid.cell_fields})
            for (const Field& field : *fields)
                if (auto set = look(field.name, field.values); !set) return set;
    }
    return {};
}

} // namespace isotet::io::vtk
