// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include <isotet/device.hpp>
#include <isotet/export.hpp>
#include <isotet/pack.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>

namespace isotet {

namespace render {
class TetPages;
class ChosenTets;
}

/// Ways to draw an isosurface without ever making it: the vertex shader cuts the tets while they are drawn. Those of
/// Buatois, Caumon and Levy (2006), to be compared with extraction.
///
/// `registers`             the paper's GPU(R) (Pascucci 2004, Reck and others 2004): each of the four vertices of a tet
///                         carries all four corners, x, y, z and value, and its own number: 4 x 68 bytes a tet
/// `registers_instanced`   the same, but the four vertices share one record: 64 bytes a tet
/// `textures`              the paper's GPU(T): 16 bytes a tet, its four point numbers; 16 a point, x, y, z and value;
///                         16 more a point for shading by gradients; the tables of cases and edges in the same store
/// `mesh`                  what the paper hoped of a geometry unit: mesh shaders (VK_EXT_mesh_shader) make the
///                         triangles of 32 tets at a time, and nothing of those that are not cut. The store of
///                         textures, and 8 bytes, their range, for every 32 tets; not every device has mesh shaders
enum class DrawMethod : std::uint8_t { registers, registers_instanced, textures, mesh };

inline constexpr std::array all_draw_methods{DrawMethod::registers, DrawMethod::registers_instanced,
                                             DrawMethod::textures, DrawMethod::mesh};

/// The name as written here, and back.
ISOTET_API std::string_view name_of(DrawMethod method) noexcept;
ISOTET_API std::optional<DrawMethod> parse_draw_method(std::string_view name) noexcept;

struct TetStoreOptions {
    bool gradients = false; ///< shading by the gradients of the packed grid, `textures` and `mesh` only; without them
                            ///< by faces
    /// Device memory that uploading leaves free for pictures and lists of tets; nothing: an eighth of what is free.
    std::optional<std::uint64_t> picture_bytes;
};

/// What a store takes, in bytes.
ISOTET_API std::uint64_t tet_store_bytes(DrawMethod method, std::uint64_t tets, std::uint64_t points,
                                         bool gradients) noexcept;

struct TetStoreReport {
    std::uint64_t tets = 0, points = 0;
    std::uint64_t stored_bytes = 0; ///< tet_store_bytes(): device_bytes + host_bytes
    std::uint64_t device_bytes = 0; ///< in the device's memory
    std::uint64_t host_bytes = 0;   ///< found no room there: sent over the bus again for every part of every picture
    double seconds = 0;             ///< for uploading
};

/// Tets that are drawn at an isovalue, `DrawnSurface::tets` of a scene. Keeps what it needs of its store alive. Moving
/// is cheap.
class ISOTET_API TetSurface {
public:
    TetSurface(TetSurface&&) noexcept;
    TetSurface& operator=(TetSurface&&) noexcept;
    ~TetSurface();

    double isovalue() const noexcept;
    std::uint64_t tets() const noexcept;       ///< that are drawn, cut or not
    std::uint64_t sent_bytes() const noexcept; ///< over the bus for this isovalue: the numbers of the tets, if it has a
                                               ///< list
    std::uint64_t bytes_per_picture() const noexcept; ///< of the store, over the bus for each part of a picture

    /// The triangles, in the user's coordinates, worked out by a kernel of the same source as the vertex shader. Half a
    /// table of cases loses which side is above, so it is not told which way they face; triangles of which two corners
    /// lie in one place are left out.
    ///
    /// Guarantees   else the triangles of extract(), corner by corner, whatever the method
    /// Cost         48 bytes a tet over the bus
    /// Errors       out_of_memory; device_failed
    Result<std::vector<std::array<std::array<double, 3>, 3>>> triangles() const;

private:
    friend class TetStore;
    friend class Renderer;
    explicit TetSurface(std::unique_ptr<render::ChosenTets> tets);
    std::unique_ptr<render::ChosenTets> tets_;
};

/// All tets of a packed grid in a device's memory, as a method wants them. They have the numbers that TetIndex has.
///
/// It lies in pages of 65,536 tets. Pages that find no room in the device's memory stay in the machine's, and cross the
/// bus for every picture: slower, the same picture.
///
/// Threads   one call at a time on one device
/// Method    docs/inside/render.md
class ISOTET_API TetStore {
public:
    /// Uploads a store. The packed grid is not needed any more; with another field the store must be uploaded again.
    ///
    /// Errors   invalid_argument for a grid packed in double, for gradients with a method that keeps none, and for
    ///          gradients that the grid was not packed with; invalid_data with 2^32 - 1 tets or more; out_of_memory
    ///          when the device has no room for one page (textures, mesh: for all points and one page), or the machine
    ///          none for the rest; no_device without mesh shaders where they are asked for; device_failed; cancelled
    /// Cost     the store over the bus
    static Result<TetStore> upload(const Device& device, const PackedGrid& packed, DrawMethod method,
                                   const TetStoreOptions& options = {}, const Run& run = {});

    TetStore(TetStore&&) noexcept;
    TetStore& operator=(TetStore&&) noexcept;
    ~TetStore();

    const TetStoreReport& report() const noexcept;

    /// All tets, to be drawn at an isovalue. Nothing is sent but the isovalue.
    /// Errors   invalid_argument when the isovalue is not finite
    Result<TetSurface> at(double isovalue);

    /// These tets only, as TetIndex finds them.
    ///
    /// Cost     4 bytes a tet over the bus
    /// Errors   invalid_argument when the isovalue is not finite, or a tet is none of the grid's; out_of_memory;
    ///          device_failed
    Result<TetSurface> at(double isovalue, std::span<const std::uint32_t> tets);

private:
    explicit TetStore(std::shared_ptr<render::TetPages> pages);
    std::shared_ptr<render::TetPages> pages_;
};

} // namespace isotet
