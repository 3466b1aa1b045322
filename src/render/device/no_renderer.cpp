// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What stands for renderer.cpp in a build without Vulkan: there is no device, so nothing can be uploaded or drawn.
#include <isotet/draw_tets.hpp>
#include <isotet/render.hpp>

namespace isotet {

namespace render {
class MeshBuffers {};
class FieldBuffer {};
class ChosenTets {};
class TetPages {
public:
    TetStoreReport report;
};
} // namespace render

struct Renderer::Data {
    DeviceWork work;
    VolumeWork volume_work;
};

namespace {

Error built_without() { return {ErrorCode::no_device, "isotet was built without Vulkan (ISOTET_VULKAN=OFF)"}; }

} // namespace

DeviceMesh::DeviceMesh(std::unique_ptr<render::MeshBuffers> buffers) : buffers_(std::move(buffers)) {}
DeviceMesh::DeviceMesh(DeviceMesh&&) noexcept = default;
DeviceMesh& DeviceMesh::operator=(DeviceMesh&&) noexcept = default;
DeviceMesh::~DeviceMesh() = default;
std::uint64_t DeviceMesh::vertex_count() const noexcept { return 0; }
std::uint64_t DeviceMesh::triangle_count() const noexcept { return 0; }
Result<DeviceMesh> DeviceMesh::upload(const Device&, const Surface&) { return built_without(); }

DeviceColors::DeviceColors(std::unique_ptr<render::FieldBuffer> buffer) : buffer_(std::move(buffer)) {}
DeviceColors::DeviceColors(DeviceColors&&) noexcept = default;
DeviceColors& DeviceColors::operator=(DeviceColors&&) noexcept = default;
DeviceColors::~DeviceColors() = default;
Result<DeviceColors> DeviceColors::of_mesh(const Device&, const Array&, Association, const ColorScale&) {
    return built_without();
}
Result<DeviceColors> DeviceColors::of_grid(const Device&, const PackedGrid&, const Array&, Association,
                                           const ColorScale&) {
    return built_without();
}

Renderer::Renderer(std::unique_ptr<Data> data) : data_(std::move(data)) {}
Renderer::Renderer(Renderer&&) noexcept = default;
Renderer& Renderer::operator=(Renderer&&) noexcept = default;
Renderer::~Renderer() = default;
const DeviceWork& Renderer::work() const noexcept { return data_->work; }
const VolumeWork& Renderer::volume_work() const noexcept { return data_->volume_work; }
Result<Renderer> Renderer::create(const Device&) { return built_without(); }
Result<Picture> Renderer::draw(const Scene&, const PictureOptions&, const Run&) { return built_without(); }

TetSurface::TetSurface(std::unique_ptr<render::ChosenTets> tets) : tets_(std::move(tets)) {}
TetSurface::TetSurface(TetSurface&&) noexcept = default;
TetSurface& TetSurface::operator=(TetSurface&&) noexcept = default;
TetSurface::~TetSurface() = default;
double TetSurface::isovalue() const noexcept { return 0; }
std::uint64_t TetSurface::tets() const noexcept { return 0; }
std::uint64_t TetSurface::sent_bytes() const noexcept { return 0; }
std::uint64_t TetSurface::bytes_per_picture() const noexcept { return 0; }
Result<std::vector<std::array<std::array<double, 3>, 3>>> TetSurface::triangles() const { return built_without(); }

TetStore::TetStore(std::shared_ptr<render::TetPages> pages) : pages_(std::move(pages)) {}
TetStore::TetStore(TetStore&&) noexcept = default;
TetStore& TetStore::operator=(TetStore&&) noexcept = default;
TetStore::~TetStore() = default;
const TetStoreReport& TetStore::report() const noexcept { return pages_->report; }
Result<TetStore> TetStore::upload(const Device&, const PackedGrid&, DrawMethod, const TetStoreOptions&, const Run&) {
    return built_without();
}
Result<TetSurface> TetStore::at(double) { return built_without(); }
Result<TetSurface> TetStore::at(double, std::span<const std::uint32_t>) { return built_without(); }

} // namespace isotet
