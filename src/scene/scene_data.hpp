// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What an IsosurfaceScene has. Beside what is shown for some isovalues there is what is there for all of them.
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <isotet/boundary.hpp>
#include <isotet/device.hpp>
#include <isotet/isosurface_scene.hpp>

namespace isotet {

namespace scene {
inline constexpr Color single_color{0.92F, 0.48F, 0.16F, 1}; ///< stands out from the boundary, and from blue and green
}

struct IsosurfaceScene::Data {
    std::optional<Device> device; ///< that draws; nothing: the CPU does
    SceneLook look = {};
    std::optional<Surface> surface = {}; ///< that was given; else there is
    std::optional<Contour> contour = {}; ///< with gradient normals
    std::optional<Solids> solids = {};   ///< in its place
    ContourInput without_device = {};    ///< of the session, if it has a device: to go on without it
    bool required = false;               ///< the device
    Box bounds = {};
    std::optional<Surface> boundary = {};
    std::vector<Surface> slices = {};
    std::vector<DrawnLines> edges = {};         ///< of slices and boundary
    std::vector<DrawnLines> surface_edges = {}; ///< of what is shown
    std::optional<TetStore> store = {};
    std::optional<TetIndex> index = {};
    std::optional<DeviceColors> grid_colors = {};
    std::vector<TetSurface> tets = {};
    std::vector<DeviceSurface> on_device = {};
    std::deque<DeviceMesh> meshes = {}; ///< places that do not move
    std::deque<DeviceColors> mesh_colors = {};
    std::deque<Surface> extracted = {}; ///< without a device
    std::deque<SurfaceColors> values = {};
    std::deque<DeviceMesh> fixed_meshes = {}; ///< of what is there for all isovalues
    std::deque<DeviceColors> fixed_colors = {};
    std::deque<SurfaceColors> fixed_values = {};
    std::vector<DrawnSurface> fixed = {}; ///< slices and boundary
    std::vector<Box> boxes = {};          ///< of surfaces shown; empty where they are on the device
    std::vector<SurfacePoints> points = {}; ///< likewise
    Scene scene = {};
    std::vector<ShownSurface> shown = {};
    SceneReport report = {};
    std::optional<PackedGrid> volume_grid = {}; ///< that is drawn as a volume
    bool pack_is_told = false; ///< the report has what the next extraction tells of packing
    std::vector<std::string> notes = {};

    Result<void> look_around(const Grid& grid, KnownBoundary* known, const Run& run);
    Result<void> look_around_packed(const IsosurfaceOptions& options, const Run& run);
    Result<void> make_slices(const std::function<Result<Surface>(const Plane& plane)>& cut);
    void take_boundary(Surface found);
    Result<void> add_boundary();
    Result<void> add_fixed(const Surface& one, const ColorField* field, const Color& color, double opacity);
    Result<void> start(IsosurfaceOptions options, const Run& run);
    Result<void> start_packed(const IsosurfaceOptions& options, const Run& run);
    Result<void> load_tets(const IsosurfaceOptions& options, const Run& run);
    Result<void> show_tets(std::span<const double> isovalues);
    Result<void> show_extracted(std::span<const double> isovalues, const Run& run);
    Result<void> show_solids(std::span<const double> isovalues, const Run& run);
    Result<void> show_on_device(std::span<const double> isovalues, const Run& run);
    Result<void> add_surface(Surface one);
    bool draws_surface_edges() const { return look.edges && (surface || (!boundary && slices.empty())); }
    std::vector<bool> find_hiding() const;
    std::uint64_t smallest_size() const;
    void dress();
    void add_volume();
    void clear();
};

} // namespace isotet
