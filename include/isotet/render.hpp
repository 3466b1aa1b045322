// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <isotet/device.hpp>
#include <isotet/export.hpp>
#include <isotet/picture.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>
#include <isotet/scene.hpp>
#include <isotet/surface.hpp>

namespace isotet {

/// A colour and what it means.
struct LegendEntry {
    Color color;
    std::string text;
};

/// The axes of the world as small arrows, and how long a round number is in the picture.
///
/// `camera`   of the scene's picture
/// `bar`      a scale bar: lengths are right in a parallel picture, and in a perspective one at the camera's target
/// `unit`     of coordinates, written behind the bar's number
struct Orientation {
    Camera camera;
    bool bar = false;
    std::string unit;
};

/// What is written beside a picture: at the right a colour scale with ticks at round numbers, or a legend, or both,
/// under a title, and the axes; below a caption and a scale bar. Without scale and legend the axes stand in the lower left
/// corner of the scene. Text is UTF-8; a font is part of isotet, with Latin and Greek letters, and what it
/// lacks is a box.
struct Annotation {
    std::string title;
    std::optional<ColorScale> scale;
    OpacityCurve opacity = {}; ///< of a volume, a line over the scale: transparent at its left edge, the most opaque at
                               ///< its right; without points: none
    std::string no_data; ///< what the scale's colour for no data means; empty: it is not shown
    std::vector<LegendEntry> legend;
    std::string caption; ///< cut off with an ellipsis where it is too long
    std::optional<Orientation> orientation;

    bool empty() const noexcept { return !scale && legend.empty() && caption.empty() && !orientation; }
};

/// How many letters of a text the font lacks, each of which is drawn as a box. Bytes that are not UTF-8 count, too.
/// Errors   internal when the font cannot be opened
ISOTET_API Result<std::size_t> count_missing_letters(std::string_view text);

struct PictureSize {
    std::uint32_t width = 0, height = 0;
};

/// What an annotation leaves, in a picture of `whole`, for what is drawn; nothing when that would be less than half of
/// its width or height: then the picture is too small for text.
/// Errors   internal when the font cannot be opened
ISOTET_API Result<std::optional<PictureSize>> room_beside(const Annotation& annotation, PictureSize whole);

/// A picture of `whole`, with a scene of the size that room_beside() says in its upper left corner, and the annotation
/// beside it: dark on light backgrounds, light on dark ones. An empty background stays empty.
///
/// Guarantees   the same bytes for the same version of FreeType
/// Errors       invalid_argument when the scene has another size; internal when the font cannot be opened
ISOTET_API Result<Picture> annotate(const Picture& scene, const Annotation& annotation, PictureSize whole,
                                    const Color& background);

// Drawing on the processor: needs no driver.

/// What drawing the volumes of a scene took.
struct VolumeWork {
    std::uint64_t clusters = 0; ///< that are neither transparent nor out of view
    std::uint64_t tets = 0;     ///< placed in a tile of the picture, each in each tile
    std::uint64_t segments = 0; ///< of rays in tets
    std::uint64_t bytes = 0;    ///< of memory beyond scene and picture
};

/// Draws a scene of surfaces in memory, of lines and of volumes. Light, blending and samples are those of Renderer,
/// which this function is the reference of. Through volumes one ray a pixel is followed, in its middle: what is opaque
/// ends it sample by sample, what is translucent stands where it is in the pixel's middle.
///
/// `work`       becomes what volumes took
/// Guarantees   the same bytes for any thread count and on every machine, and however points of a volume are numbered
///              and its tets ordered; without volumes, beside the picture of Renderer at most 1/255 in a channel, except
///              in 0.1 % of the pixels. What a homogeneous medium lets through is right to 2 x 10^-5
/// Cost         O(triangles + fragments); transient memory about 60 bytes a vertex, 20 a triangle. Of volumes
///              O(clusters + tets that are not transparent, in each tile + segments); 8 bytes a group of 32 tets, 3 MB a
///              thread
/// Errors       invalid_argument when a size, a camera, an opacity or a width is out of range, colours do not fit their
///              surface, a surface is in a device's memory, or a volume has no grid, or a wrong scale, opacity, length
///              or isovalue; invalid_data when a triangle has a vertex that is not there, or a vertex is not finite;
///              out_of_memory; cancelled
/// Threads      safe from many threads
/// Method       tiles of pixels; a depth buffer of samples for what is opaque, sorted lists of fragments for what is
///              not, and of segments of rays in tets; docs/inside/render.md
ISOTET_API Result<Picture> draw(const Scene& scene, const PictureOptions& options, const Run& run = {});
ISOTET_API Result<Picture> draw(const Scene& scene, const PictureOptions& options, const Run& run, VolumeWork& work);

// Drawing on a Vulkan device.

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

    /// Draws a picture. With volumes it is that of draw(), byte for byte: the processor draws it, but for the rays
    /// through volumes, which the device follows. Surfaces are then in memory.
    ///
    /// Cost     O(triangles) a part of the picture (parts have 16 million samples); device memory 28 bytes a sample of
    ///          a part and 16 a translucent fragment
    /// Errors   invalid_argument when a size, a camera or an opacity is out of range, or colours do not fit their
    ///          surface; out_of_memory of the device, with the amount needed; device_failed; cancelled; with volumes as
    ///          draw(), and no_device when the device finds other light in
    ///          small volumes than the processor
    Result<Picture> draw(const Scene& scene, const PictureOptions& options, const Run& run = {});

    /// What the last call of draw() cost.
    const DeviceWork& work() const noexcept;
    /// What volumes took in the last call that drew some: tets in blocks of 16 x 8 pixels, bytes of the device.
    const VolumeWork& volume_work() const noexcept;

private:
    struct Data;
    explicit Renderer(std::unique_ptr<Data> data);
    std::unique_ptr<Data> data_;
};

} // namespace isotet
