// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// A device as the engine of a session.
#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include <isotet/device.hpp>

#include "base/array_slot.hpp"
#include "base/errors.hpp"
#include "base/system/memory.hpp"
#include "base/parallel.hpp"

namespace isotet {

namespace {

class GridOfSession final : public EngineGrid {
public:
    GridOfSession(DeviceGrid grid, std::vector<std::string> notes) : grid_(std::move(grid)), notes_(std::move(notes)) {}

    DeviceGrid& grid() noexcept { return grid_; }

    const PackedGrid& packed() const noexcept override { return grid_.packed(); }
    Result<void> set_field(const PointField& field, const Run& run) override { return grid_.set_field(field, run); }
    Result<void> set_points(const Array& points, const Run& run) override { return grid_.set_points(points, run); }
    DeviceWork work() const override { return work_; }
    std::vector<std::string> notes() const override { return notes_; }

    Result<std::vector<Extraction>> extract(std::span<const double> isovalues, const ExtractOptions& options,
                                            const Run& run) override {
        std::vector<Extraction> extractions;
        ExtractOptions on_device = options;
        on_device.sink = nullptr;
        for (const double isovalue : isovalues) {
            if (auto ok = grid_.extract(isovalue, surface_, on_device, run); !ok) return ok.error();
            work_ = grid_.work();
            auto extraction = grid_.download(surface_, run);
            if (!extraction) return extraction.error();
            work_.downloaded_bytes += grid_.work().downloaded_bytes;
            if (options.sink)
                core::with_threads(run.threads, [&] {
                    core::RememberingSink(options.sink).bring(extraction->surface, extractions.size());
                });
            extractions.push_back(*std::move(extraction));
        }
        return extractions;
    }

private:
    DeviceGrid grid_;
    DeviceSurface surface_; ///< used again for the next isovalue
    DeviceWork work_;
    std::vector<std::string> notes_;
};

class VulkanEngine final : public Engine {
public:
    VulkanEngine(const Device& device, const DeviceGridOptions& options) : device_(device), options_(options) {}

    std::string_view name() const noexcept override { return "vulkan"; }
    bool is_stateless() const noexcept override { return false; }

    Result<std::unique_ptr<EngineGrid>> create_grid(const PackedGrid& packed, const Run& run) const override {
        constexpr std::uint64_t min_page_bytes = 16 << 10, min_pages = 16;
        DeviceGridOptions options = options_;
        options.page_bytes = std::min(options.page_bytes, std::max(min_page_bytes, device_.memory_free() / min_pages));
        Result<DeviceGrid> grid = DeviceGrid::upload(device_, packed, options, run);
        if (!grid) return grid.error();
        std::vector<std::string> notes;
        if (!grid->complete())
            notes.push_back(
                fmt::format("not all of the packed grid, {}, fits into the device's memory: its parts come and go",
                            core::format_bytes(DeviceGrid::needs(packed, options).all())));
        return std::unique_ptr<EngineGrid>(std::make_unique<GridOfSession>(*std::move(grid), std::move(notes)));
    }

private:
    Device device_;
    DeviceGridOptions options_;
};

} // namespace

std::shared_ptr<const Engine> vulkan_engine(const Device& device, const DeviceGridOptions& options) {
    return std::make_shared<const VulkanEngine>(device, options);
}

Result<SurfacesOnDevice> extract_on_device(Contour& contour, std::span<const double> isovalues, const Run& run) {
    SurfacesOnDevice found;
    const auto extract = [&](EngineGrid& grid, const ExtractOptions& options) -> Result<void> {
        auto* const on_device = dynamic_cast<GridOfSession*>(&grid);
        if (!on_device) return invalid_argument("the session has another engine than a device");
        auto surfaces = on_device->grid().extract(isovalues, options, run);
        if (!surfaces) return surfaces.error();
        found = {*std::move(surfaces), on_device->grid().work()};
        return {};
    };
    if (auto ok = contour.use_grid(isovalues.size(), extract, run); !ok) return ok.error();
    return found;
}

} // namespace isotet
