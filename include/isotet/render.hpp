// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Drawing on a Vulkan device. draw.hpp draws without one.
#pragma once

#include <cstdint>
#include <memory>

#include <isotet/device.hpp>
#include <isotet/device_grid.hpp>
#include <isotet/export.hpp>
#include <isotet/picture.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>
#include <isotet/scene.hpp>
#include <isotet/surface.hpp>

namespace isotet {

namespace render {
class MeshBuffers;
class FieldBuffer;
}

/// Triangles in a device's memory that were uploaded, ready to be drawn. Moving is cheap; it keeps the device open.
class ISOTET_API DeviceMesh {
public:
    /// Uploads positions, triangles and, where there is one a vertex, normals.
    ///
    /// Cost     12 to 24 bytes a vertex and 12 a triangle over the bus
    /// Errors   invalid_argument when the surface has 2^32 vertices or triangles or more, or arrays that do not fit
    ///          together; invalid_data when a triangle has a vertex that is not there, or a vertex is not finite;
    ///          out_of_memory; device_failed
    static Result<DeviceMesh> upload(const Device& device, const Surface& surface);

    DeviceMesh(DeviceMesh&&) noexcept;
    DeviceMesh& operator=(DeviceMesh&&) noexcept;
    ~DeviceMesh();

    std::uint64_t vertex_count() const noexcept;
    std::uint64_t triangle_count() const noexcept;

private:
    friend class Renderer;
    explicit DeviceMesh(std::unique_ptr<render::MeshBuffers> buffers);
    std::unique_ptr<render::MeshBuffers> buffers_;
};

/// Values in a device's memory that colour a mesh, or surfaces of a grid. Moving is cheap; it keeps the device open.
class ISOTET_API DeviceColors {
public:
    /// For a mesh: a scalar a vertex, or a triangle.
    /// Errors   invalid_argument when `values` has several components, or the scale is wrong; out_of_memory;
    ///          device_failed
    static Result<DeviceColors> of_mesh(const Device& device, const Array& values, Association association,
                                        const ColorScale& scale);

    /// For surfaces that are extracted on the device: a scalar a point or a cell of the user's grid. Surfaces extracted
    /// with edge_ends (points) or source_cells (cells) are coloured by it where they are: it is uploaded once, not once
    /// a surface.
    ///
    /// `packed`   the grid that was uploaded; for cells packed with source_cells
    /// Errors     as of_mesh(); invalid_argument when the number of values is not that of the grid
    static Result<DeviceColors> of_grid(const Device& device, const PackedGrid& packed, const Array& values,
                                        Association association, const ColorScale& scale);

    DeviceColors(DeviceColors&&) noexcept;
    DeviceColors& operator=(DeviceColors&&) noexcept;
    ~DeviceColors();

private:
    friend class Renderer;
    explicit DeviceColors(std::unique_ptr<render::FieldBuffer> buffer);
    std::unique_ptr<render::FieldBuffer> buffer_;
};

/// Draws scenes on a device. Nothing is read back but the picture (and a count where something is translucent). Drawing
/// on a software device works like drawing on any other.
///
/// Light comes from the eye: a surface seen at a right angle has just its own colour. Both sides are lit. Gradient
/// normals shade smoothly, without them every triangle is flat. Translucent surfaces are put in order sample by sample,
/// so that any number of them may pass through each other. Samples are averaged, and surfaces blended, in linear light.
///
/// Guarantees   the same picture every time on one device and driver
/// Threads      one call at a time on one device
/// Method       a depth buffer for what is opaque, lists of fragments for what is not; docs/inside/render.md
class ISOTET_API Renderer {
public:
    /// Cost     pipelines are built when they are first needed, 5 to 500 ms each
    /// Errors   no_device when the device cannot draw, with the reason
    static Result<Renderer> create(const Device& device);

    Renderer(Renderer&&) noexcept;
    Renderer& operator=(Renderer&&) noexcept;
    ~Renderer();

    /// Draws a picture.
    ///
    /// Cost     O(triangles) a part of the picture (parts have 16 million samples); device memory 28 bytes a sample of
    ///          a part and 16 a translucent fragment
    /// Errors   invalid_argument when a size, a camera or an opacity is out of range, or colours do not fit their
    ///          surface; out_of_memory of the device, with the amount needed; device_failed; cancelled
    Result<Picture> draw(const Scene& scene, const PictureOptions& options, const Run& run = {});

    /// What the last call of draw() cost.
    const DeviceWork& work() const noexcept;

private:
    struct Data;
    explicit Renderer(std::unique_ptr<Data> data);
    std::unique_ptr<Data> data_;
};

} // namespace isotet
