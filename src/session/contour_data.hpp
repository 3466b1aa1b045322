// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What a session holds between calls, and the steps by which it follows its input.
#pragma once

#include <chrono>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <isotet/contour.hpp>

#include "session/curved_input.hpp"
#include "session/linear_input.hpp"
#include "session/marks.hpp"

namespace isotet {

namespace session {

inline double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

ExtractOptions extract_options(const ContourOptions& options, const ContourInput& input);

} // namespace session

struct Contour::Data {
    std::mutex mutex; ///< of all that follows
    session::LinearInput linear;
    session::MetInput met;       ///< where only cells that isovalues meet were made linear: `input` has these
    session::CurvedInput curved; ///< where cells are refined in extract(): `input` is then what was refined last
    ContourInput input;          ///< with linear cells; without the grid when that is packed
    ContourOptions options;
    FieldSample sample;
    std::uint64_t asked = 0;    ///< surfaces so far
    std::uint64_t set_count = 0; ///< how often `input` was set
    bool direct_for_memory = false;
    std::optional<PackedGrid> packed; ///< of the input, but for what `behind` says
    bool is_given = false;            ///< ContourInput::packed
    ContourUpdate behind = ContourUpdate::grid;
    std::optional<session::CellsMark> cells;
    std::optional<session::ArrayMark> points, field;
    std::unique_ptr<EngineGrid> grid; ///< of an engine that keeps one
    std::optional<FieldReport> range; ///< found by a look at the grid
    double update_seconds = 0;
    std::vector<std::string> notes;

    void note_new_cells();
    enum class Met { some, not_chosen };
    void start_over(FieldSample next_sample, const ContourOptions& next_options);
    Result<Met> take_met(const ContourInput& next, const ContourOptions& next_options, const Run& run);
    bool is_enough_for(std::span<const double> isovalues) const;
    /// An input with all of its cells.
    struct Completed {
        ContourInput input;
        session::LinearInput linear;
        FieldSample sample;
        double seconds = 0;
    };
    static Result<Completed> completed(const ContourInput& input, const session::MetInput& met,
                                       session::LinearInput linear, const ContourOptions& options, const Run& run);
    void take(Completed all);
    Result<void> complete(const Run& run);
    Result<void> take_curved(ContourInput next, const ContourOptions& next_options);
    Result<ContourUpdate> take_packed(ContourInput next, const ContourOptions& next_options, const Run& run);
    ContourUpdate what_changed(const ContourInput& next, const ContourOptions& next_options, const Run& run);
    Result<void> refine_for(std::span<const double> isovalues, const Run& run);
    const FieldReport& field_of_curved() {
        if (!range) range = curved.field();
        return *range;
    }
    std::shared_ptr<const LinearGrid> linear_grid() const {
        return curved ? curved.grid() : met ? met.grid() : linear.grid();
    }
    Method method_of_next(std::size_t isovalues) const;
    Result<void> prepare(std::size_t isovalues, const Run& run);
    Result<void> bring_up_to_date(const Run& run);
    Result<void> pack_grid(const Run& run);
    Result<void> change_points(const Run& run);
    Result<void> change_field(const Run& run);
    Result<void> create_grid(const Run& run);
    Result<void> without_engine(const Error& error);
    Result<void> extract_from_grid(std::span<const double> isovalues, const Run& run, ContourResult& result);
};

} // namespace isotet
