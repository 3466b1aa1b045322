// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <isotet/contour.hpp>
#include <isotet/engine.hpp>
#include <isotet/export.hpp>
#include <isotet/extract.hpp>
#include <isotet/pack.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>

namespace isotet {

namespace vulkan {
class Context;
}

enum class DeviceKind : std::uint8_t { discrete, integrated, virtual_gpu, software, other };

/// "discrete GPU", "integrated GPU", "virtual GPU", "software", "other".
ISOTET_API std::string_view name_of(DeviceKind kind) noexcept;

/// A Vulkan device, as its driver describes it.
struct DeviceInfo {
    std::size_t index = 0; ///< its place in list_devices(), which a choice may name
    std::string name;      ///< "NVIDIA GeForce RTX 4070"
    DeviceKind kind = DeviceKind::other;
    std::string driver;             ///< name and version: "NVIDIA 550.54.14"
    std::string api;                ///< Vulkan version: "1.3.277"
    std::uint64_t memory = 0;       ///< bytes of the device's own memory (of the machine's, where they are one)
    std::uint64_t memory_free = 0;  ///< of these, what this process can still take; all of `memory` where the driver
                                    ///< does not tell
    bool memory_free_known = false; ///< the driver tells (VK_EXT_memory_budget)
    bool unified_memory = false;    ///< the processor reads and writes the device's memory directly
    bool transfer_queue = false;    ///< copies to and from the device have a queue of their own
    bool timestamps = false;        ///< times of passes can be measured
    std::uint64_t allocation_limit = 0;           ///< bytes of the largest buffer
    std::array<std::uint32_t, 3> workgroups = {}; ///< most workgroups of one dispatch, an axis
    std::uint32_t workgroup_size = 0;             ///< most invocations of a workgroup
    std::uint32_t shared_memory = 0;              ///< bytes a workgroup
    std::uint32_t subgroup_size = 0;
    std::string unusable; ///< why isotet cannot use it, a sentence; empty: it can
};

/// What there is on this machine.
struct DeviceList {
    std::vector<DeviceInfo> devices; ///< in the driver's order, unusable ones too
    std::optional<std::size_t> best; ///< the one that Device::open() takes without a choice, if there is one
    std::string unavailable;         ///< why there is no Vulkan at all, a sentence; empty: there is
};

/// Looks for Vulkan devices. Opens the Vulkan loader (libvulkan.so.1) at run time: without it, or without a driver,
/// `unavailable` says so.
///
/// Cost      about 50 ms
/// Errors    out_of_memory; no Vulkan and no device are none
/// Threads   safe from many threads
ISOTET_API Result<DeviceList> list_devices();

struct DeviceOptions {
    /// "": the best real GPU that can be used (discrete before integrated before virtual, then the most memory), never
    /// a software device. "software": the software device. A number: the index in list_devices(). Else a part of a
    /// name, in small or capital letters, that fits one device only.
    std::string choice;
    std::uint64_t memory_limit = 0; ///< bytes of device memory that buffers may take in all; 0: what the driver says is
                                    ///< free
    bool share_memory = false;      ///< for DeviceSurface::share(); needs VK_KHR_external_memory_fd
};

/// A Vulkan device of a program that draws, as Vulkan gives its handles.
///
/// The instance is made for Vulkan 1.2 or newer; the device has the features bufferDeviceAddress and scalarBlockLayout.
struct VulkanHandles {
    void* instance = nullptr;               ///< VkInstance
    void* physical_device = nullptr;        ///< VkPhysicalDevice
    void* device = nullptr;                 ///< VkDevice
    void* queue = nullptr;                  ///< VkQueue of the device, that computes; and draws, for a Renderer
    std::uint32_t queue_family = 0;         ///< of the queue
    void* get_instance_proc_addr = nullptr; ///< PFN_vkGetInstanceProcAddr; null: that of libvulkan.so.1
    bool fragment_stores = false;           ///< the feature fragmentStoresAndAtomics is on: a Renderer needs it
    bool external_memory = false;           ///< VK_KHR_external_memory_fd is on: DeviceOptions::share_memory needs it
};

/// A device that is ready to work. Copies share it.
///
/// Threads   one operation at a time on one device; different devices are independent
class ISOTET_API Device {
public:
    /// Opens a device and tests its arithmetic on the device itself, and its kernels on two small grids against the CPU engine
    /// (docs/inside/gpu.md).
    ///
    /// Cost      100 ms to a second, mostly the driver's; compiled kernels are kept in XDG_CACHE_HOME/isotet
    /// Errors    invalid_argument when no device, or more than one, fits the choice; no_device when there is no Vulkan,
    ///           no GPU, or when the device cannot be used, with the reason; also when its driver builds wrong kernels
    static Result<Device> open(const DeviceOptions& options = {});

    /// Works on a device that the caller has opened: surfaces are then in its own memory, to be drawn without a copy
    /// (DeviceSurface::arrays()).
    ///
    /// The handles stay the caller's, and must live until the last copy of the Device and all that was made with it is
    /// gone. While a function of isotet works on the device nothing else may be submitted to its queue; what was
    /// submitted has ended when the function returns.
    ///
    /// `options`   without a choice
    /// Cost, errors   as open(); invalid_argument when a handle is missing or the queue does not compute
    static Result<Device> adopt(const VulkanHandles& handles, const DeviceOptions& options = {});

    /// A device that was opened with settings of its own, by tests.
    explicit Device(std::shared_ptr<vulkan::Context> context) : context_(std::move(context)) {}
    Device(const Device&) = default; // no move: a device that was moved from stays what it was
    Device& operator=(const Device&) = default;
    ~Device() = default;

    const DeviceInfo& info() const noexcept;

    /// What the user should know: that the device failed the arithmetic test, so that bytes may differ from the CPU's.
    const std::vector<std::string>& notices() const noexcept;

    std::uint64_t memory_used() const; ///< bytes of device memory that buffers take now
    std::uint64_t memory_free() const; ///< bytes that can still be taken, within the limit

    const std::shared_ptr<vulkan::Context>& context() const noexcept { return context_; }

private:
    std::shared_ptr<vulkan::Context> context_;
};

namespace vulkan {
class GridOnDevice;
class SurfaceBuffers;
}

struct DeviceGridOptions {
    std::uint64_t page_bytes = std::uint64_t{32} << 20; ///< of a page, 1 GiB at most: what is moved at once where not
                                                        ///< all of the grid fits
    /// Device memory that uploading leaves free for surfaces where not all of the grid fits; nothing: an eighth of what
    /// is free.
    std::optional<std::uint64_t> surface_bytes;
};

/// Device memory that a packed grid takes.
struct DeviceGridNeeds {
    std::uint64_t resident_bytes = 0;     ///< always there: ranges, counts and masks of all clusters
    std::uint64_t page_bytes = 0;         ///< all pages; fewer will do
    std::uint64_t largest_page_bytes = 0; ///< one page is the least
    std::size_t pages = 0;

    std::uint64_t all() const noexcept { return resident_bytes + page_bytes; }
    std::uint64_t least() const noexcept { return resident_bytes + largest_page_bytes; }
};

/// An array in a device's memory.
struct DeviceArray {
    std::uint64_t buffer = 0;  ///< VkBuffer whose first byte is the array's: for vertices, indices, storage and copies
    std::uint64_t address = 0; ///< VkDeviceAddress of its first byte
    std::uint64_t bytes = 0;   ///< of the array; the buffer may have more. 0: there is no such array
    int memory = -1;           ///< of share(): a file descriptor of the memory that the array lies in, else -1
    std::uint64_t memory_bytes = 0; ///< of that memory, for VkMemoryAllocateInfo::allocationSize
    std::uint64_t offset = 0;       ///< of the array in it
    std::uint32_t memory_type = 0;  ///< for VkMemoryAllocateInfo::memoryTypeIndex
};

/// The arrays of a surface in a device's memory, in the order in which a download has them.
struct DeviceArrays {
    DeviceArray positions; ///< float32, 3 a vertex, relative to DeviceSurface::origin()
    DeviceArray triangles; ///< uint32, 3 a triangle
    DeviceArray normals;   ///< float32, 3 a vertex of gradient normals, 3 a triangle of face normals
};

/// A surface in a device's memory, ready to be drawn. Moving is cheap; it keeps the device open.
///
/// `vertices`, `triangle_count`   fewer than 2^32
class ISOTET_API DeviceSurface {
public:
    DeviceSurface();
    DeviceSurface(DeviceSurface&&) noexcept;
    DeviceSurface& operator=(DeviceSurface&&) noexcept;
    ~DeviceSurface();

    double isovalue() const noexcept;
    std::array<double, 3> origin() const noexcept; ///< positions are relative to it
    std::uint64_t vertex_count() const noexcept;
    std::uint64_t triangle_count() const noexcept;
    std::uint64_t device_bytes() const noexcept; ///< taken, with the room that is kept for the next surface

    /// The arrays where they are, for a program that has the same device (Device::adopt()). They are complete, and stay
    /// until the surface is extracted into again or goes. Empty before any extraction.
    DeviceArrays arrays() const;

    /// The arrays with file descriptors of their memory (VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT), for a program
    /// with another instance, or for CUDA and OpenGL. That memory has other arrays too: it may be read only. Each
    /// descriptor is the caller's, to be imported or closed.
    ///
    /// Errors   invalid_argument when the device was not opened with DeviceOptions::share_memory, or before any
    ///          extraction; device_failed
    Result<DeviceArrays> share() const;

    /// The buffers, for drawing; src/vulkan/engine/surface_buffers.hpp says what stands where. Null before any
    /// extraction.
    const vulkan::SurfaceBuffers* buffers() const noexcept;

private:
    friend class DeviceGrid;
    struct Data;
    std::unique_ptr<Data> data_;
};

/// A packed grid on a device: uploaded once, then each new isovalue is answered there, and only what is asked for comes
/// back.
///
/// The grid lies on the device in pages. Where not all of them fit, those that an isovalue needs are loaded, and the
/// least recently used ones go: slower, the same surfaces.
///
/// Guarantees   surfaces are the same bytes as those of extract() on the same packed grid, unless the device has a
///              notice
/// Threads      one call at a time on one device
/// Method       marching tetrahedra over clusters in compute shaders; docs/inside/gpu.md
class ISOTET_API DeviceGrid {
public:
    /// What upload() will need, told before anything is taken; nothing of a grid that lies in a file.
    /// Cost   a pass over the links of the packed grid
    static DeviceGridNeeds needs(const PackedGrid& packed, const DeviceGridOptions& options = {});

    /// Uploads a packed grid, and keeps a handle on it.
    ///
    /// `packed`   single precision
    /// Cost       about 11 bytes a tet over the bus
    /// Errors     invalid_argument when the grid was packed in double precision, or has 2^32 points or more;
    ///            out_of_memory, before anything is uploaded, when needs().least() is more than is free; device_failed;
    ///            cancelled
    static Result<DeviceGrid> upload(const Device& device, const PackedGrid& packed,
                                     const DeviceGridOptions& options = {}, const Run& run = {});

    DeviceGrid(DeviceGrid&&) noexcept;
    DeviceGrid& operator=(DeviceGrid&&) noexcept;
    ~DeviceGrid();

    /// The grid that is on the device: the one that was uploaded, or what set_field() and set_points() made of it.
    const PackedGrid& packed() const noexcept;

    /// Replaces the contoured field (another field, or the next time step): values go up, ranges are worked out on the
    /// device and come back.
    ///
    /// Guarantees   packed() is then byte for byte what PackedGrid::with_field() gives
    /// Cost         a pass over the values and 4 bytes a point over the bus, 0.1 bytes a tet back; gradients, and
    ///              ranges of pages that are not on the device, are worked out on the processor
    /// Errors       as PackedGrid::with_field(): nothing has changed then; of the device: out_of_memory,
    ///              device_failed. The grid must be uploaded again then; packed() is what it was
    Result<void> set_field(const PointField& field, const Run& run = {});

    /// Replaces the coordinates (a mesh that moves).
    ///
    /// Guarantees   packed() is then byte for byte what PackedGrid::with_points() gives
    /// Cost         PackedGrid::with_points(), and 12 bytes a point over the bus
    /// Errors       as PackedGrid::with_points(): nothing has changed then; the others as set_field()
    Result<void> set_points(const Array& points, const Run& run = {});

    std::uint64_t device_bytes() const noexcept; ///< resident arrays and the pages that are there
    bool complete() const noexcept;              ///< all pages are there

    /// Extracts the surface of an isovalue; it stays on the device. `options` as for extract().
    ///
    /// Point fields are uploaded once, 4 bytes a point and component, and stay while their arrays live (borrowed ones
    /// are uploaded each time); where there is no room for them, download() interpolates instead.
    ///
    /// Cost     on the device O(C + V + F) in four dependent steps; over the bus 200 bytes, and new fields. Where pages
    ///          must be loaded: these, up to twice
    /// Errors   as extract(); invalid_argument when the surface has 2^32 vertices or triangles or more; out_of_memory
    ///          of the device; device_failed
    Result<DeviceSurface> extract(double isovalue, const ExtractOptions& options = {}, const Run& run = {});

    /// The same, into a surface that was extracted before: its memory is used again where it is large enough.
    Result<void> extract(double isovalue, DeviceSurface& surface, const ExtractOptions& options = {},
                         const Run& run = {});

    /// The surfaces of several isovalues, in their order, in one submission where everything fits.
    Result<std::vector<DeviceSurface>> extract(std::span<const double> isovalues, const ExtractOptions& options = {},
                                               const Run& run = {});

    /// A surface of this grid, on the processor, with all that was asked for when it was extracted.
    ///
    /// Cost     the arrays over the bus; cell fields are copied here
    Result<Extraction> download(const DeviceSurface& surface, const Run& run = {});

    /// What the last call of a function above cost.
    const DeviceWork& work() const noexcept;

private:
    struct Data;
    explicit DeviceGrid(std::unique_ptr<Data> data);
    Result<void> extract_into(std::span<const double> isovalues, std::span<DeviceSurface> surfaces,
                              const ExtractOptions& options, const Run& run);
    std::unique_ptr<Data> data_;
};

/// The engine that extracts on a device, for a session: ContourOptions::engine. Grids are uploaded in pages of at most a
/// sixteenth of the memory that is free.
ISOTET_API std::shared_ptr<const Engine> vulkan_engine(const Device& device, const DeviceGridOptions& options = {});

/// Surfaces on a device, and what they cost.
struct SurfacesOnDevice {
    std::vector<DeviceSurface> surfaces; ///< in the order of the isovalues
    DeviceWork work;
};

/// Surfaces of a session whose engine is vulkan_engine(). They stay on the device, to be drawn there.
///
/// Errors   as Contour::extract() and DeviceGrid::extract(); invalid_argument when the session has another engine, or
///          has given the device up
ISOTET_API Result<SurfacesOnDevice> extract_on_device(Contour& contour, std::span<const double> isovalues,
                                                      const Run& run = {});

} // namespace isotet
