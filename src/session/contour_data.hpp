// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What a session holds between calls.
#pragma once

#include <cstdint>
#include <mutex>
#include <optional>
#include <span>

#include <isotet/contour.hpp>

#include "session/packed_state.hpp"
#include "session/source.hpp"

namespace isotet {

struct Contour::Data {
    /// What is known of the input's field.
    struct Look {
        FieldSample sample;
        std::optional<FieldReport> range;
    };
    /// What was asked for so far.
    struct Asked {
        std::uint64_t surfaces = 0, inputs = 0;
    };

    std::mutex mutex; ///< of all that follows
    session::Source source;
    session::PackedState state; ///< the source's cells are given back when they are packed
    ContourOptions options;
    Look look;
    Asked asked;
    bool direct_for_memory = false;
    session::Told told;

    Result<ContourUpdate> set(ContourInput next, const ContourOptions& next_options, const Run& run);
    Result<void> get_cells_for(std::span<const double> isovalues, const Run& run);
    Result<void> get_all_cells(const Run& run);
    Result<void> keep_all_cells(const session::Source& all, const ContourOptions& of, std::uint64_t inputs);
    Method method_of_next(std::size_t isovalues) const;
    Result<void> prepare(std::size_t isovalues, const Run& run);
    bool packs_aside() const;
    Result<void> pack_aside(const Run& run);
    const FieldReport& field_of_curved();
};

} // namespace isotet
