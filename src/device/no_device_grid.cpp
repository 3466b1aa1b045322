// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What stands for device_grid.cpp in a build without Vulkan: there is no device to upload to, so nothing else can be
// called.
#include <isotet/device.hpp>

namespace isotet {

struct DeviceSurface::Data {};
struct DeviceGrid::Data {
    PackedGrid packed;
    DeviceWork work;
};

namespace {

Error built_without() { return {ErrorCode::no_device, "isotet was built without Vulkan (ISOTET_VULKAN=OFF)"}; }

} // namespace

DeviceSurface::DeviceSurface() = default;
DeviceSurface::DeviceSurface(DeviceSurface&&) noexcept = default;
DeviceSurface& DeviceSurface::operator=(DeviceSurface&&) noexcept = default;
DeviceSurface::~DeviceSurface() = default;

double DeviceSurface::isovalue() const noexcept { return 0; }
std::array<double, 3> DeviceSurface::origin() const noexcept { return {}; }
std::uint64_t DeviceSurface::vertex_count() const noexcept { return 0; }
std::uint64_t DeviceSurface::triangle_count() const noexcept { return 0; }
std::uint64_t DeviceSurface::device_bytes() const noexcept { return 0; }
DeviceArrays DeviceSurface::arrays() const { return {}; }
Result<DeviceArrays> DeviceSurface::share() const { return built_without(); }
const vulkan::SurfaceBuffers* DeviceSurface::buffers() const noexcept { return nullptr; }

DeviceGrid::DeviceGrid(std::unique_ptr<Data> data) : data_(std::move(data)) {}
DeviceGrid::DeviceGrid(DeviceGrid&&) noexcept = default;
DeviceGrid& DeviceGrid::operator=(DeviceGrid&&) noexcept = default;
DeviceGrid::~DeviceGrid() = default;

DeviceGridNeeds DeviceGrid::needs(const PackedGrid&, const DeviceGridOptions&) { return {}; }
Result<DeviceGrid> DeviceGrid::upload(const Device&, const PackedGrid&, const DeviceGridOptions&, const Run&) {
    return built_without();
}
Result<void> DeviceGrid::set_field(const PointField&, const Run&) { return built_without(); }
Result<void> DeviceGrid::set_points(const Array&, const Run&) { return built_without(); }
const PackedGrid& DeviceGrid::packed() const noexcept { return data_->packed; }
std::uint64_t DeviceGrid::device_bytes() const noexcept { return 0; }
bool DeviceGrid::complete() const noexcept { return false; }
const DeviceWork& DeviceGrid::work() const noexcept { return data_->work; }

Result<DeviceSurface> DeviceGrid::extract(double, const ExtractOptions&, const Run&) { return built_without(); }
Result<void> DeviceGrid::extract(double, DeviceSurface&, const ExtractOptions&, const Run&) { return built_without(); }
Result<std::vector<DeviceSurface>> DeviceGrid::extract(std::span<const double>, const ExtractOptions&, const Run&) {
    return built_without();
}
Result<Extraction> DeviceGrid::download(const DeviceSurface&, const Run&) { return built_without(); }

} // namespace isotet
