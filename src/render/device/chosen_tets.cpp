// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "render/device/chosen_tets.hpp"

#include <cmath>

#include <fmt/core.h>

#include "render/device/send.hpp"

namespace isotet::render {

Result<std::unique_ptr<ChosenTets>> ChosenTets::choose(std::shared_ptr<const TetPages> store, double isovalue,
                                                       std::optional<std::span<const std::uint32_t>> list) {
    if (!std::isfinite(isovalue))
        return Error{ErrorCode::invalid_argument, fmt::format("the isovalue is {}, but must be finite", isovalue)};
    auto chosen = std::make_unique<ChosenTets>();
    chosen->stored_ = core::store_isovalue<float>(isovalue, store->storage);
    chosen->isovalue_ = isovalue;
    chosen->store_ = std::move(store);
    chosen->has_list_ = list.has_value();
    if (!list) chosen->take_all();
    else if (Result<void> taken = chosen->take_list(*list); !taken) return taken.error();
    return chosen;
}

void ChosenTets::take_all() {
    for (const TetPages::Page& page : store_->pages) parts_.push_back({&page, 0, page.tets});
}

/// Puts the numbers in order of pages; inside a page they keep their order.
Result<void> ChosenTets::take_list(std::span<const std::uint32_t> list) {
    const std::uint64_t tets = store_->report.tets;
    std::vector<std::uint64_t> next(store_->pages.size() + 1);
    for (const std::uint32_t tet : list) {
        if (tet >= tets)
            return Error{ErrorCode::invalid_argument,
                         fmt::format("tet {} shall be drawn, but the grid has {} tets", tet, tets)};
        ++next[tet / layout::page_tets + 1];
    }
    for (std::size_t page = 0; page < store_->pages.size(); ++page) {
        if (next[page + 1] > 0)
            parts_.push_back({&store_->pages[page], next[page], static_cast<std::uint32_t>(next[page + 1])});
        next[page + 1] += next[page];
    }
    if (list.empty()) return {};
    core::Buffer<std::uint32_t> numbers(list.size());
    for (const std::uint32_t tet : list) numbers[next[tet / layout::page_tets]++] = tet % layout::page_tets;
    Result<vulkan::Buffer> sent = send(*store_->context, numbers, "numbers of tets");
    if (!sent) return sent.error();
    numbers_ = *std::move(sent);
    return {};
}

std::uint64_t ChosenTets::tets() const noexcept {
    std::uint64_t tets = 0;
    for (const Part& part : parts_) tets += part.tets;
    return tets;
}

std::uint64_t ChosenTets::bytes_per_picture() const noexcept {
    std::uint64_t bytes = 0;
    for (const Part& part : parts_)
        if (!part.page->on_device) bytes += part.page->records.size();
    return bytes;
}

layout::TetPage ChosenTets::describe(const Part& part) const {
    layout::TetPage page{};
    page.records = vulkan::address_of(store_->place_of(*part.page));
    if (has_list_) page.numbers = vulkan::address_of(numbers_, part.first * sizeof(std::uint32_t));
    page.points = vulkan::address_of(store_->points);
    page.gradients = vulkan::address_of(store_->directions);
    page.tables = vulkan::address_of(store_->tables);
    if (store_->ranges) {
        const auto index = static_cast<std::uint64_t>(part.page - store_->pages.data());
        page.ranges = vulkan::address_of(store_->ranges,
                                         index * (layout::page_tets / layout::tet_group) * sizeof(core::CutRange));
    }
    page.isovalue = stored_.value;
    page.rest = stored_.rest;
    page.tets = part.tets;
    return page;
}

void ChosenTets::add_uses(const Part& part, vulkan::Access how, std::vector<vulkan::Use>& uses) const {
    for (const vulkan::Buffer* buffer : {&store_->place_of(*part.page), &numbers_, &store_->points, &store_->directions,
                                         &store_->tables, &store_->ranges})
        if (*buffer) uses.push_back({*buffer, how});
}

} // namespace isotet::render
