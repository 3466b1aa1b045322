// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// isotet::Renderer: a picture is planned, cut into parts, and each part drawn by a Frame.
#include <algorithm>

#include <fmt/core.h>

#include <isotet/draw_tets.hpp>
#include <isotet/render.hpp>

#include "base/errors.hpp"
#include "base/carry_out.hpp"
#include "base/guard.hpp"
#include "packed/packed.hpp"
#include "packed/residency.hpp"
#include "render/check_drawing.hpp"
#include "render/cpu/draw_tuned.hpp"
#include "render/device/field_buffer.hpp"
#include "render/device/frame.hpp"
#include "render/device/mesh_buffers.hpp"
#include "render/device/view.hpp"
#include "render/device/volume_rays.hpp"

namespace isotet {

namespace {

/// Whether there is anything to draw: tets, a mesh, or a surface that was extracted.
bool has_triangles(const DrawnSurface& drawn) {
    if (drawn.opacity == 0) return false;
    if (drawn.tets) return drawn.tets->tets() > 0;
    if (drawn.triangles) return drawn.triangles->triangle_count() > 0;
    if (drawn.mesh) return drawn.mesh->triangle_count() > 0;
    return drawn.surface && drawn.surface->triangle_count() > 0;
}

} // namespace

DeviceMesh::DeviceMesh(std::unique_ptr<render::MeshBuffers> buffers) : buffers_(std::move(buffers)) {}
DeviceMesh::DeviceMesh(DeviceMesh&&) noexcept = default;
DeviceMesh& DeviceMesh::operator=(DeviceMesh&&) noexcept = default;
DeviceMesh::~DeviceMesh() = default;
std::uint64_t DeviceMesh::vertex_count() const noexcept { return buffers_ ? buffers_->vertices : 0; }
std::uint64_t DeviceMesh::triangle_count() const noexcept { return buffers_ ? buffers_->triangle_count : 0; }

Result<DeviceMesh> DeviceMesh::upload(const Device& device, const Surface& surface) {
    return core::guarded("uploading a surface", [&]() -> Result<DeviceMesh> {
        auto buffers = render::MeshBuffers::upload(device.context(), surface);
        if (!buffers) return buffers.error();
        return DeviceMesh(*std::move(buffers));
    });
}

DeviceColors::DeviceColors(std::unique_ptr<render::FieldBuffer> buffer) : buffer_(std::move(buffer)) {}
DeviceColors::DeviceColors(DeviceColors&&) noexcept = default;
DeviceColors& DeviceColors::operator=(DeviceColors&&) noexcept = default;
DeviceColors::~DeviceColors() = default;

Result<DeviceColors> DeviceColors::of_mesh(const Device& device, const Array& values, Association association,
                                           const ColorScale& scale) {
    return core::guarded("uploading colours", [&]() -> Result<DeviceColors> {
        const std::uint32_t coloring =
            association == Association::point ? render::layout::by_vertex : render::layout::by_triangle;
        auto buffer = render::FieldBuffer::upload(
            device.context(), values, coloring, values.tuples(), [](std::uint64_t i) { return i; }, scale);
        if (!buffer) return buffer.error();
        return DeviceColors(*std::move(buffer));
    });
}

Result<DeviceColors> DeviceColors::of_grid(const Device& device, const PackedGrid& packed, const Array& values,
                                           Association association, const ColorScale& scale) {
    return core::guarded("uploading colours", [&]() -> Result<DeviceColors> {
        const auto whole = core::whole_of(packed.shared_data(), {});
        if (!whole) return whole.error();
        const core::Packed& data = **whole;
        const bool of_points = association == Association::point;
        const std::uint64_t needed = of_points ? data.user_points : data.user_cells;
        if (values.tuples() != needed)
            return invalid_argument(fmt::format("{} values shall colour a grid of {} {}", values.tuples(), needed,
                                                of_points ? "points" : "cells"));
        if (!of_points && !data.has_cell_ids())
            return invalid_argument("a grid that is coloured by its cells must be packed with source_cells");
        const std::uint64_t count = of_points ? data.points() : data.cell_ids.size() + data.wide_cell_ids.size();
        const auto number = [&](std::uint64_t i) { return of_points ? data.user_point(i) : data.user_cell(i); };
        const std::uint32_t coloring = of_points ? render::layout::by_grid_point : render::layout::by_grid_tet;
        auto buffer = render::FieldBuffer::upload(device.context(), values, coloring, count, number, scale);
        if (!buffer) return buffer.error();
        return DeviceColors(*std::move(buffer));
    });
}

struct Renderer::Data {
    Device device;
    std::unique_ptr<render::Frame> frame;
    DeviceWork work = {};
    VolumeWork volume_work = {};
    std::unique_ptr<render::VolumeRays> rays = {}; ///< once there was a volume

    Result<render::Draws> plan(const Scene& scene, const PictureOptions& options, const render::Space& space);
    Result<Picture> draw(const Scene& scene, const PictureOptions& options, const Progress& progress);
    Result<Picture> draw_volumes(const Scene& scene, const PictureOptions& options, const Progress& progress);
};

Result<render::Draws> Renderer::Data::plan(const Scene& scene, const PictureOptions& options,
                                           const render::Space& space) {
    render::Draws draws;
    for (const DrawnLines& lines : scene.lines) {
        if (lines.lines.empty()) continue;
        Result<render::LineDraw> draw =
            render::make_line_draw(frame->context(), frame->pipelines(), space, lines, options.samples);
        if (!draw) return draw.error();
        draws.lines.push_back(*std::move(draw));
    }
    for (const DrawnSurface& drawn : scene.surfaces) {
        if (!has_triangles(drawn)) continue;
        if (drawn.tets) {
            const Result<const vulkan::Buffer*> corners = frame->quad_corners();
            if (!corners) return corners.error();
            const Result<void> added =
                render::add_tet_draws(frame->pipelines(), space, drawn, *drawn.tets->tets_, **corners, draws.tets);
            if (!added) return added.error();
            continue;
        }
        const render::MeshBuffers* mesh = drawn.mesh ? drawn.mesh->buffers_.get() : nullptr;
        const render::FieldBuffer* colors = drawn.colors ? drawn.colors->buffer_.get() : nullptr;
        if (drawn.triangles) {
            Result<DeviceMesh> uploaded = DeviceMesh::upload(device, *drawn.triangles);
            if (!uploaded) return uploaded.error();
            mesh = draws.uploaded.emplace_back(std::move(uploaded->buffers_)).get();
            colors = nullptr;
        }
        if (drawn.triangles && drawn.values) {
            const SurfaceColors& values = *drawn.values;
            Result<DeviceColors> uploaded =
                DeviceColors::of_mesh(device, values.values, values.association, values.scale);
            if (!uploaded) return uploaded.error();
            colors = draws.uploaded_colors.emplace_back(std::move(uploaded->buffer_)).get();
        }
        Result<render::MeshDraw> draw = render::make_mesh_draw(frame->pipelines(), space, drawn, mesh, colors);
        if (!draw) return draw.error();
        draws.meshes.push_back(*std::move(draw));
    }
    return draws;
}

Result<Picture> Renderer::Data::draw(const Scene& scene, const PictureOptions& options, const Progress& progress) {
    work = {};
    if (Result<void> right = render::check_options(options); !right) return right.error();
    if (!scene.volumes.empty()) return draw_volumes(scene, options, progress);
    const render::Space space(scene.bounds);
    Result<render::Draws> draws = plan(scene, options, space);
    if (!draws) return draws.error();

    vulkan::Staging& staging = frame->context().staging();
    const std::uint64_t up = staging.uploaded(), down = staging.downloaded();
    Picture picture{options.width, options.height, {}};
    picture.pixels.resize(std::size_t{options.width} * options.height);
    const std::uint32_t widest = std::max(1U, frame->max_samples_per_axis() / options.samples);
    const render::Sight sight = space.look(options.camera, options.width, options.height);
    render::Part part;
    part.width = std::min(options.width, widest);
    const std::uint64_t rows =
        render::Frame::max_samples / (std::uint64_t{part.width} * options.samples * options.samples);
    const auto highest = static_cast<std::uint32_t>(std::clamp<std::uint64_t>(rows, 1, widest));
    for (part.y = 0; part.y < options.height; part.y += highest) {
        for (part.x = 0; part.x < options.width; part.x += widest) {
            if (progress.cancelled()) return Error{ErrorCode::cancelled, "drawing was cancelled"};
            part.width = std::min(options.width - part.x, widest);
            part.height = std::min(options.height - part.y, highest);
            render::layout::View view{};
            render::fill(view, sight, options, part);
            view.samples = options.samples;
            view.background = render::light_of(options.background);
            view.background_opacity = std::clamp(options.background.opacity, 0.0F, 1.0F);
            if (Result<void> drawn = frame->draw(*draws, view, part, picture, work); !drawn) return drawn.error();
        }
        progress("draw", static_cast<double>(part.y + part.height) / options.height);
    }
    work.uploaded_bytes += staging.uploaded() - up;
    work.downloaded_bytes = staging.downloaded() - down;
    return picture;
}

Result<Picture> Renderer::Data::draw_volumes(const Scene& scene, const PictureOptions& options,
                                             const Progress& progress) {
    if (!rays) rays = std::make_unique<render::VolumeRays>(device.context());
    if (Result<void> checked = rays->check(scene, options.camera.projection); !checked) return checked.error();
    vulkan::Staging& staging = frame->context().staging();
    const std::uint64_t up = staging.uploaded(), down = staging.downloaded();
    Result<Picture> picture = render::draw_with(scene, options, {}, rays.get(), progress, volume_work);
    work.uploaded_bytes = staging.uploaded() - up;
    work.downloaded_bytes = staging.downloaded() - down;
    return picture;
}

Renderer::Renderer(std::unique_ptr<Data> data) : data_(std::move(data)) {}
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;
Renderer::~Renderer() = default;
const DeviceWork& Renderer::work() const noexcept {
    static const DeviceWork none;
    return data_ ? data_->work : none;
}

const VolumeWork& Renderer::volume_work() const noexcept {
    static const VolumeWork none;
    return data_ ? data_->volume_work : none;
}

Result<Renderer> Renderer::create(const Device& device) {
    return core::guarded("preparing to draw", [&]() -> Result<Renderer> {
        auto frame = render::Frame::make(device.context());
        if (!frame) return frame.error();
        return Renderer(std::make_unique<Data>(Data{device, *std::move(frame)}));
    });
}

Result<Picture> Renderer::draw(const Scene& scene, const PictureOptions& options, const Run& run) {
    return core::carry_out("drawing", run, [&](const Progress& progress) -> Result<Picture> {
        if (!data_) return moved_from("the renderer");
        return data_->draw(scene, options, progress);
    });
}

} // namespace isotet
