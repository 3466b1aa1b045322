// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Tets of a store that are drawn at an isovalue: what isotet::TetSurface stands for inside.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "numbers/storage.hpp"
#include "render/device/tet_pages.hpp"
#include "vulkan/recorder.hpp"

namespace isotet::render {

class ChosenTets {
public:
    /// What is drawn of one page.
    struct Part {
        const TetPages::Page* page;
        std::uint64_t first; ///< in `numbers`, where there is a list
        std::uint32_t tets;
    };

    /// `list`   which tets; nothing: all
    static Result<std::unique_ptr<ChosenTets>> choose(std::shared_ptr<const TetPages> store, double isovalue,
                                                      std::optional<std::span<const std::uint32_t>> list);

    const TetPages& store() const noexcept { return *store_; }
    double isovalue() const noexcept { return isovalue_; }
    bool has_list() const noexcept { return has_list_; }
    const std::vector<Part>& parts() const noexcept { return parts_; }
    std::uint64_t tets() const noexcept;
    std::uint64_t sent_bytes() const noexcept { return numbers_.size(); }
    std::uint64_t bytes_per_picture() const noexcept; ///< of pages that are not on the device

    /// What shaders need to know of a part, the look aside.
    layout::TetPage describe(const Part& part) const;

    /// The buffers that shaders read for a part, used as `how`.
    void add_uses(const Part& part, vulkan::Access how, std::vector<vulkan::Use>& uses) const;

    Result<std::vector<std::array<std::array<double, 3>, 3>>> triangles() const;

private:
    void take_all();
    Result<void> take_list(std::span<const std::uint32_t> list);

    std::shared_ptr<const TetPages> store_; ///< before the buffer, so that it goes after it
    double isovalue_ = 0;
    core::StoredIsovalue<float> stored_{0};
    bool has_list_ = false;
    vulkan::Buffer numbers_; ///< of tets in their page, page by page
    std::vector<Part> parts_;
};

} // namespace isotet::render
