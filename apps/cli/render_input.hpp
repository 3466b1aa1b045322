// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What `isotet render` draws: a scene of a surface from a file, or of a grid.
#pragma once

#include <future>
#include <optional>
#include <string>
#include <vector>

#include <isotet/isosurface_scene.hpp>
#include <isotet/write.hpp>

#include "console.hpp"
#include "grid_source.hpp"
#include "options.hpp"

namespace isotet::cli {

struct RenderInput {
    std::string format;
    bool is_surface = false;
    std::string field;               ///< that is contoured; empty for a surface file, and where nothing is
    std::optional<double> time;      ///< of the step
    std::optional<std::size_t> step; ///< where there are several
    std::vector<double> isovalues;
    std::optional<ColorField> colors; ///< of whatever is coloured
    std::uint64_t cells = 0;          ///< of the grid
    double read_seconds = 0;
    std::optional<IsosurfaceScene> scene; ///< always there
};

/// The file, and the time steps that are drawn.
class RenderSource {
public:
    /// Errors   as of reading; invalid_argument where options are for grids, but the file is a surface
    static Result<RenderSource> open(const RenderCommand& command, Console& console);

    std::size_t steps() const noexcept { return steps_.empty() ? 1 : steps_.size(); }

    /// Reads a step, chooses field and isovalues, and starts the scene. All steps have the isovalues and the colour scale
    /// of the first that is read, whose range is that of all of them.
    ///
    /// The step behind is read while this one is drawn: then there are two in memory.
    ///
    /// `device`   draws, nothing: the CPU does; extracts too if it is a graphics card, or if --engine vulkan asks for it
    /// Errors     as of reading and packing; invalid_argument where a field to colour by is none
    Result<RenderInput> read(std::size_t which, const std::optional<Device>& device, Console& console);

private:
    struct Contents; ///< of one step
    explicit RenderSource(const RenderCommand& command) : command_(command) {}
    Result<RenderInput> take_surface(const std::optional<Device>& device, Console& console);
    Result<Contents> read_contents(std::size_t step, Console& console);
    Result<void> widen_range(const std::string& color, Console& console);
    Result<Grid> read_grid(const FieldsToRead& fields, std::size_t step, Console& console);
    void read_ahead(std::size_t step, Console& console);
    SceneLook look_of(const Contents& contents) const;

    RenderCommand command_; ///< with the isovalues and the range of the first step
    std::string surface_format_;
    std::optional<Surface> surface_;
    double surface_seconds_ = 0;
    std::optional<GridSource> source_;
    std::vector<std::size_t> steps_;

    FieldsToRead last_read_;          ///< of the last step
    std::future<Result<Grid>> ahead_; ///< the next step, with the same fields
    std::size_t ahead_step_ = 0;
};

} // namespace isotet::cli
