// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What `isotet render` draws, in the device's memory: extracted there, or on the CPU and uploaded.
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include <isotet/annotation.hpp>
#include <isotet/contour.hpp>
#include <isotet/render.hpp>

#include "console.hpp"
#include "options.hpp"
#include "render_input.hpp"
#include "render_tets.hpp"

namespace isotet::cli {

/// A surface that is drawn, or the tets that stand for it.
struct SurfaceCounts {
    std::optional<double> isovalue; ///< nothing for a surface file
    std::uint64_t vertices = 0, triangles = 0;
    std::uint64_t tets = 0, sent_bytes = 0; ///< of a method that draws tets: how many, and bytes over the bus for this
                                            ///< isovalue

    std::uint64_t size() const { return triangles + tets; }
};

class RenderScene {
public:
    RenderScene(const RenderCommand& command, RenderInput& input, const Device& device, Console& console)
        : command_(command), input_(input), device_(device), console_(console) {}

    /// Uploads what is the same for all isovalues.
    Result<void> load();

    /// Makes the scene that of these isovalues; of a surface file there are none.
    Result<void> show(const std::vector<double>& isovalues);

    /// Sees the whole grid, or the whole surface: the same for all isovalues, and from all sides of an orbit at the
    /// same distance.
    void fit(Camera& camera, double aspect) const;

    const Scene& scene() const noexcept { return scene_; }
    const std::vector<SurfaceCounts>& surfaces() const noexcept { return counts_; }
    Annotation annotation() const;
    std::vector<std::string> isovalue_texts() const; ///< of surfaces(), each different

    /// "vulkan", "cpu", or "none" where nothing is extracted: of a surface file, or by a method that draws tets.
    const char* engine() const { return input_.surface || tets_ ? "none" : on_device_ ? "vulkan" : "cpu"; }
    std::string_view method() const; ///< of extracting or of drawing tets; "none" for a surface file
    const RenderTets* tets() const { return tets_ ? &*tets_ : nullptr; } ///< null: surfaces are drawn
    double upload_seconds() const noexcept { return upload_seconds_; }
    double extract_seconds() const noexcept { return extract_seconds_; } ///< of all isovalues so far, with uploading by
                                                                         ///< the CPU engine
    const DeviceWork& extract_work() const noexcept { return work_; }    ///< empty with the CPU engine

private:
    Result<void> show_extracted(const std::vector<double>& isovalues);
    Result<void> extract_on_device(const std::vector<double>& isovalues);
    Result<void> choose_tets(const std::vector<double>& isovalues);
    Result<void> extract_on_cpu(const std::vector<double>& isovalues);
    Result<void> add_mesh(const Surface& surface);
    Result<void> add_colors(DrawnSurface& drawn, const Surface& surface);
    bool is_empty(std::size_t surface) const;
    void dress();

    const RenderCommand& command_;
    RenderInput& input_;
    const Device& device_;
    Console& console_;
    std::optional<DeviceMesh> boundary_;
    std::optional<DeviceColors> grid_colors_;
    std::optional<RenderTets> tets_;
    std::vector<DeviceSurface> surfaces_;   ///< by the Vulkan engine
    std::deque<DeviceMesh> meshes_;         ///< uploaded; places that do not move
    std::deque<DeviceColors> mesh_colors_;
    Scene scene_;
    std::vector<SurfaceCounts> counts_;
    bool on_device_ = false;
    Method method_ = Method::direct;
    double upload_seconds_ = 0, extract_seconds_ = 0;
    DeviceWork work_;
};

} // namespace isotet::cli
