// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <isotet/device.hpp>

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <unistd.h>

#include "api/finish.hpp"
#include "api/fits.hpp"
#include "api/ties.hpp"
#include "packed/field_storage.hpp"
#include "base/array_slot.hpp"
#include "base/carry_out.hpp"
#include "base/errors.hpp"
#include "base/guard.hpp"
#include "base/rising_progress.hpp"
#include "packed/residency.hpp"
#include "packed/set_field.hpp"
#include "numbers/storage.hpp"
#include "vulkan/engine/grid_on_device.hpp"

namespace isotet {

struct DeviceSurface::Data {
    std::shared_ptr<vulkan::Context> context;   ///< before the buffers, so that it goes after them
    std::shared_ptr<const core::Packed> packed; ///< the grid as it was when this was extracted
    vulkan::SurfaceBuffers buffers;
    double isovalue = 0;
    std::size_t number = 0; ///< in the call that extracted it
    core::StoredIsovalue<float> stored{0};
    std::vector<core::Storage>
        storages; ///< of the point fields that were interpolated on the device: of all, or of none
    ExtractOptions options;

    Result<Extraction> download() const;
};

using FieldsOnDevice = std::vector<std::shared_ptr<const vulkan::CarriedField>>;

struct DeviceGrid::Data {
    PackedGrid packed;
    std::unique_ptr<vulkan::GridOnDevice> grid;
    DeviceWork work;

    Result<void> extract(std::span<const double> isovalues, std::span<DeviceSurface> surfaces,
                         const ExtractOptions& options, const FieldsOnDevice& fields, const Progress& progress);
};

DeviceSurface::DeviceSurface() = default;
DeviceSurface::DeviceSurface(DeviceSurface&&) noexcept = default;
DeviceSurface& DeviceSurface::operator=(DeviceSurface&&) noexcept = default;
DeviceSurface::~DeviceSurface() = default;

double DeviceSurface::isovalue() const noexcept { return data_ ? data_->isovalue : 0; }
std::array<double, 3> DeviceSurface::origin() const noexcept {
    return data_ ? data_->packed->origin : std::array<double, 3>{};
}
std::uint64_t DeviceSurface::vertex_count() const noexcept { return data_ ? data_->buffers.vertex_count() : 0; }
std::uint64_t DeviceSurface::triangle_count() const noexcept { return data_ ? data_->buffers.triangle_count() : 0; }
std::uint64_t DeviceSurface::device_bytes() const noexcept { return data_ ? data_->buffers.bytes() : 0; }
const vulkan::SurfaceBuffers* DeviceSurface::buffers() const noexcept { return data_ ? &data_->buffers : nullptr; }

DeviceArrays DeviceSurface::arrays() const {
    if (!data_) return {};
    const vulkan::SurfaceBuffers& buffers = data_->buffers;
    const auto array = [](const vulkan::Buffer& buffer, std::uint64_t tuples) -> DeviceArray {
        if (!buffer || tuples == 0) return {};
        constexpr std::uint64_t tuple_bytes = 12;         // three words
        return {.buffer = (std::uint64_t)buffer.handle(), // NOLINT: a pointer or a number, as Vulkan has it
                .address = buffer.address(),
                .bytes = tuples * tuple_bytes};
    };
    const bool by_face = buffers.parts().normals == Normals::face;
    return {array(buffers.positions, vertex_count()), array(buffers.triangles, triangle_count()),
            array(buffers.normals, by_face ? triangle_count() : vertex_count())};
}

Result<DeviceArrays> DeviceSurface::share() const {
    return core::guarded("sharing the surface", [&]() -> Result<DeviceArrays> {
        if (!data_) return Error{ErrorCode::invalid_argument, "the surface to share was never extracted"};
        const vulkan::Memory& memory = data_->context->memory();
        if (!memory.can_share())
            return Error{ErrorCode::invalid_argument, "the device was not opened with `share_memory`"};
        DeviceArrays arrays = this->arrays();
        const std::array<std::pair<DeviceArray*, const vulkan::Buffer*>, 3> all{
            {{&arrays.positions, &data_->buffers.positions},
             {&arrays.triangles, &data_->buffers.triangles},
             {&arrays.normals, &data_->buffers.normals}}};
        for (const auto& [array, buffer] : all) {
            if (array->bytes == 0) continue;
            const Result<vulkan::Memory::Place> place = memory.share(*buffer);
            if (!place) {
                for (const auto& [other, unused] : all)
                    if (other->memory >= 0) close(other->memory);
                return place.error();
            }
            array->memory = place->descriptor;
            array->memory_bytes = place->block_bytes;
            array->offset = place->offset;
            array->memory_type = place->type;
        }
        return arrays;
    });
}

DeviceGrid::DeviceGrid(std::unique_ptr<Data> data) : data_(std::move(data)) {}
DeviceGrid::DeviceGrid(DeviceGrid&&) noexcept = default;
DeviceGrid& DeviceGrid::operator=(DeviceGrid&&) noexcept = default;
DeviceGrid::~DeviceGrid() = default;

namespace {

vulkan::SurfaceParts parts_of(const ExtractOptions& options, const FieldsOnDevice& fields) {
    const bool on_device = options.normals != Normals::vertex; // else after the download
    vulkan::SurfaceParts parts{on_device ? options.normals : Normals::none,
                               options.edge_ends || !options.point_fields.empty(),
                               options.source_cells || !options.cell_fields.empty(),
                               {}};
    for (const auto& field : fields) parts.fields.push_back(field->components);
    return parts;
}

/// The point fields on the device: all of them, or none where there is not room for all.
Result<FieldsOnDevice> carry(vulkan::GridOnDevice& grid, const ExtractOptions& options) {
    FieldsOnDevice fields;
    if (!grid.complete()) grid.fields().clear(); // pages need the room
    if (!grid.complete()) return fields;
    for (const Field& field : options.point_fields) {
        auto carried = grid.fields().get(grid.context(), *grid.packed(), field);
        if (!carried && carried.error().code == ErrorCode::out_of_memory) {
            grid.fields().clear();
            return FieldsOnDevice();
        }
        if (!carried) return carried.error();
        fields.push_back(*std::move(carried));
    }
    return fields;
}

DeviceWork work_of(vulkan::WorkDone&& done) {
    DeviceWork work;
    for (vulkan::Timing& pass : done.timings.passes) work.passes.push_back({std::move(pass.pass), pass.seconds});
    work.device_seconds = done.timings.device_seconds;
    work.waited_seconds = done.timings.waited_seconds;
    work.uploaded_bytes = done.uploaded;
    work.downloaded_bytes = done.downloaded;
    work.page_loads = done.page_loads;
    work.submissions = done.submissions;
    return work;
}

} // namespace

const PackedGrid& DeviceGrid::packed() const noexcept {
    static const PackedGrid none;
    return data_ ? data_->packed : none;
}

DeviceGridNeeds DeviceGrid::needs(const PackedGrid& packed, const DeviceGridOptions& options) {
    if (!packed.data().single() || packed.data().residency) return {};
    const vulkan::GridNeeds needs = vulkan::GridOnDevice::needs(packed.data(), options.page_bytes);
    return {needs.resident, needs.pages, needs.largest_page, needs.page_count};
}

Result<DeviceGrid> DeviceGrid::upload(const Device& device, const PackedGrid& packed, const DeviceGridOptions& options,
                                      const Run& run) {
    return core::carry_out("uploading the packed grid", run, [&](const Progress& progress) -> Result<DeviceGrid> {
        vulkan::GridOptions grid_options;
        grid_options.page_bytes = options.page_bytes;
        grid_options.reserve = options.surface_bytes.value_or(device.memory_free() / 8);
        const auto whole = core::whole_of(packed.shared_data(), progress);
        if (!whole) return whole.error();
        auto grid = vulkan::GridOnDevice::upload(device.context(), *whole, grid_options, progress);
        if (!grid) return std::move(grid).error();
        return DeviceGrid(std::make_unique<Data>(Data{PackedGrid(*whole), *std::move(grid), {}}));
    });
}

/// As the device made it; but cell fields, and point fields that were not interpolated there, as after any engine.
Result<Extraction> DeviceSurface::Data::download() const {
    const bool fields_are_there = !buffers.fields.empty();
    const bool ends = options.edge_ends || (!options.point_fields.empty() && !fields_are_there);
    auto raw = buffers.download(*context, *packed, ends);
    if (!raw) return std::move(raw).error();
    ExtractOptions the_rest = options;
    if (options.normals != Normals::vertex) the_rest.normals = Normals::none;
    std::vector<core::Storage> stored_as = storages;
    if (!fields_are_there)
        for (const Field& field : options.point_fields) stored_as.push_back(core::choose_storage(field, *packed));
    Extraction out;
    out.surface = api::finish<float>({packed->origin, packed->point_type}, the_rest, stored_as, *raw);
    if (options.normals != Normals::vertex) {
        out.surface.normals_kind = options.normals;
        out.surface.normals = raw->normals;
    }
    if (auto told = api::report_ties(*packed, isovalue, stored, raw->tied_points, out.report, {}); !told)
        return told.error();
    if (options.sink) core::RememberingSink(options.sink).bring(out.surface, number);
    out.report.selected_clusters = raw->selected_clusters;
    out.report.surface_bytes = api::bytes_of(out.surface);
    return out;
}

Result<void> DeviceGrid::set_field(const PointField& field, const Run& run) {
    return core::carry_out("setting the field on the device", run, [&](const Progress& progress) -> Result<void> {
        if (!data_) return moved_from("the grid on the device");
        if (auto ok = core::check_field(field, data_->packed.user_point_count()); !ok) return ok;
        const auto next = std::make_shared<core::Packed>(data_->packed.data());
        if (auto stored = core::store_values<float>(field, *next, progress); !stored) return stored;
        if (!next->gradients.empty()) core::store_gradients(*next);
        auto done = data_->grid->set_field(next, progress);
        if (!done) return done.error();
        data_->work = work_of(*std::move(done));
        data_->packed = PackedGrid(next);
        return {};
    });
}

Result<void> DeviceGrid::set_points(const Array& points, const Run& run) {
    return core::guarded("setting the points on the device", [&]() -> Result<void> {
        if (!data_) return moved_from("the grid on the device");
        const Result<PackedGrid> next = data_->packed.with_points(points, run);
        if (!next) return next.error();
        auto done = data_->grid->set_points(next->shared_data(), core::rising(run.progress));
        if (!done) return done.error();
        data_->work = work_of(*std::move(done));
        data_->packed = *next;
        return {};
    });
}

std::uint64_t DeviceGrid::device_bytes() const noexcept { return data_ ? data_->grid->device_bytes() : 0; }
bool DeviceGrid::complete() const noexcept { return data_ && data_->grid->complete(); }

const DeviceWork& DeviceGrid::work() const noexcept {
    static const DeviceWork none;
    return data_ ? data_->work : none;
}

Result<std::vector<DeviceSurface>> DeviceGrid::extract(std::span<const double> isovalues, const ExtractOptions& options,
                                                       const Run& run) {
    std::vector<DeviceSurface> surfaces(isovalues.size());
    if (auto ok = extract_into(isovalues, surfaces, options, run); !ok) return ok.error();
    return surfaces;
}

Result<DeviceSurface> DeviceGrid::extract(double isovalue, const ExtractOptions& options, const Run& run) {
    DeviceSurface surface;
    if (auto ok = extract(isovalue, surface, options, run); !ok) return ok.error();
    return surface;
}

Result<void> DeviceGrid::extract(double isovalue, DeviceSurface& surface, const ExtractOptions& options,
                                 const Run& run) {
    return extract_into(std::span(&isovalue, 1), std::span(&surface, 1), options, run);
}

/// `fields`   of the options, on the device; empty: they are interpolated after the download
Result<void> DeviceGrid::Data::extract(std::span<const double> isovalues, std::span<DeviceSurface> surfaces,
                                       const ExtractOptions& options, const FieldsOnDevice& fields,
                                       const Progress& progress) {
    std::vector<vulkan::Task> tasks;
    for (std::size_t i = 0; i < isovalues.size(); ++i) {
        auto& data = surfaces[i].data_;
        if (!data || data->context != grid->shared_context()) data = std::make_unique<DeviceSurface::Data>();
        data->context = grid->shared_context();
        data->isovalue = isovalues[i];
        data->number = i;
        data->packed = packed.shared_data();
        data->stored = core::store_isovalue<float>(isovalues[i], data->packed->storage);
        data->storages.clear();
        for (const auto& field : fields) data->storages.push_back(field->storage);
        data->options = options;
        if (auto ok = data->buffers.prepare(grid->context(), parts_of(options, fields)); !ok) return ok;
        tasks.push_back({data->stored, options.ties, data->buffers, fields});
    }
    auto done = grid->extract(tasks, progress);
    if (!done) return done.error();
    work = work_of(*std::move(done));
    return {};
}

Result<void> DeviceGrid::extract_into(std::span<const double> isovalues, std::span<DeviceSurface> surfaces,
                                      const ExtractOptions& options, const Run& run) {
    return core::carry_out("extraction", run, [&](const Progress& progress) -> Result<void> {
        if (!data_) return moved_from("the grid on the device");
        vulkan::GridOnDevice& grid = *data_->grid;
        if (auto ok = api::check_isovalues(isovalues); !ok) return ok;
        if (auto ok = api::check_fit(options, data_->packed.data()); !ok) return ok;
        if (!options.packed_fields.empty())
            return invalid_argument(
                "fields of packed grids are carried by the CPU only: unpack_field() gives them as arrays");
        const std::uint64_t up = grid.context().staging().uploaded();
        auto fields = carry(grid, options);
        if (!fields) return fields.error();
        auto done = data_->extract(isovalues, surfaces, options, *fields, progress);
        if (!done && done.error().code == ErrorCode::out_of_memory && !fields->empty()) {
            // Fields can be interpolated elsewhere, surfaces cannot.
            fields->clear();
            grid.fields().clear();
            done = data_->extract(isovalues, surfaces, options, {}, progress);
        }
        if (!done) return done;
        data_->work.uploaded_bytes = grid.context().staging().uploaded() - up;
        progress("extract", 1);
        return {};
    });
}

Result<Extraction> DeviceGrid::download(const DeviceSurface& surface, const Run& run) {
    return core::carry_out("downloading the surface", run, [&](const Progress& progress) -> Result<Extraction> {
        if (!data_) return moved_from("the grid on the device");
        if (!surface.data_) return Error{ErrorCode::invalid_argument, "the surface to download was never extracted"};
        const DeviceSurface::Data& data = *surface.data_;
        vulkan::Staging& staging = data.context->staging();
        const std::uint64_t down = staging.downloaded();
        Result<Extraction> result = data.download();
        data_->work = {};
        data_->work.downloaded_bytes = staging.downloaded() - down;
        progress("download", 1);
        return result;
    });
}

} // namespace isotet
