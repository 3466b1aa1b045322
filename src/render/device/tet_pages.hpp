// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// All tets of a grid on a device, in pages: what isotet::TetStore stands for inside.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include <isotet/draw_tets.hpp>

#include "packed/packed.hpp"
#include "packed/tet_table.hpp"
#include "render/layout.hpp"
#include "vulkan/context.hpp"

namespace isotet::render {

class TetPages {
public:
    /// page_tets tets, fewer in the last one.
    struct Page {
        vulkan::Buffer records;
        std::uint32_t tets = 0;
        bool on_device = false; ///< else in the machine's memory, copied to `guest` whenever it is needed
    };

    static Result<std::shared_ptr<TetPages>> upload(std::shared_ptr<vulkan::Context> context,
                                                    const core::Packed& packed, DrawMethod method,
                                                    const TetStoreOptions& options, const Progress& progress);

    std::shared_ptr<vulkan::Context> context; ///< before the buffers, so that it goes after them
    DrawMethod method = DrawMethod::textures;
    bool gradients = false;
    std::array<double, 3> origin{}; ///< places are relative to it
    core::Storage storage;          ///< of values
    vulkan::Buffer tables, points, directions; ///< of textures and mesh; no directions without gradients
    vulkan::Buffer ranges; ///< of mesh: of every layout::tet_group tets
    std::vector<Page> pages;
    vulkan::Buffer guest; ///< room for one page; none where all are on the device
    TetStoreReport report;

    /// Where the device finds the records of a page, once it is there.
    const vulkan::Buffer& place_of(const Page& page) const { return page.on_device ? page.records : guest; }

    /// Shaders that read this store are made with these constants (constant_id 0, 1, ...).
    std::array<std::uint32_t, 5> constants(bool has_list) const;

private:
    Result<void> upload_points(const core::TetTable& table, const core::Packed& packed);
    Result<void> upload_tets(const core::TetTable& table, std::uint64_t spared, const Progress& progress);
    Result<void> plan(std::uint64_t tets, std::uint64_t spared);
    Result<void> fill(Page& page, std::uint64_t first, const core::TetTable& table);
};

} // namespace isotet::render
