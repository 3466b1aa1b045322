// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "vulkan/engine/page_cache.hpp"

#include <algorithm>
#include <limits>

#include "base/parallel.hpp"
#include "vulkan/engine/address.hpp"

namespace isotet::vulkan {

namespace {

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

Error cancelled() { return {ErrorCode::cancelled, "uploading the packed grid was cancelled"}; }

} // namespace

PageCache::PageCache(Context& context, std::shared_ptr<const core::Packed> packed, std::vector<PlannedPage> plan,
                     Resident& resident)
    : context_(context), packed_(std::move(packed)), resident_(resident), plan_(std::move(plan)), pages_(plan_.size()) {
    for (const PlannedPage& page : plan_) entries_.push_back(page.layout);
    find_ranges();
}

void PageCache::find_ranges() {
    ranges_.resize(plan_.size());
    const auto& ranges = packed_->as<float>().ranges;
    core::parallel_each(plan_.size(), 1, [&](std::size_t i) {
        core::Range<float> whole{std::numeric_limits<float>::max(), std::numeric_limits<float>::lowest()};
        for (std::uint32_t c = plan_[i].first_cluster; c < plan_[i].end_cluster(); ++c) {
            whole.lower = std::min(whole.lower, ranges[c].lower);
            whole.upper = std::max(whole.upper, ranges[c].upper);
        }
        ranges_[i] = whole;
    });
}

bool PageCache::complete() const {
    return std::ranges::all_of(pages_, [](const Loaded& page) { return static_cast<bool>(page.buffer); });
}

std::vector<std::uint32_t> PageCache::hit_by(float isovalue) const {
    std::vector<std::uint32_t> pages;
    for (std::uint32_t i = 0; i < ranges_.size(); ++i)
        if (ranges_[i].lower <= isovalue && isovalue <= ranges_[i].upper) pages.push_back(i);
    return pages;
}

bool PageCache::touch(std::span<const std::uint32_t> pages) {
    ++use_;
    for (const std::uint32_t page : pages)
        if (is_loaded(page)) pages_[page].last_use = use_;
    return std::ranges::all_of(pages, [&](std::uint32_t page) { return is_loaded(page); });
}

std::uint64_t PageCache::loaded_bytes() const {
    std::uint64_t bytes = 0;
    for (const Loaded& page : pages_) bytes += page.buffer ? Memory::cost(page.buffer.size()) : 0;
    return bytes;
}

Result<void> PageCache::load_page(std::uint32_t number) {
    const PlannedPage& page = plan_[number];
    auto buffer = context_.memory().take(page.bytes(), Where::device, "page");
    if (!buffer) return std::move(buffer).error();
    std::vector<layout::Cluster> clusters(page.clusters);
    place_clusters(*packed_, page, number, clusters.data());
    core::Buffer<std::uint32_t> words(page.words);
    fill_page(*packed_, page, clusters.data(), words.data());
    if (auto ok = context_.staging().upload(*buffer, 0, std::as_bytes(std::span(words.data(), words.size()))); !ok)
        return ok;
    pages_[number].buffer = *std::move(buffer);
    entries_[number].data = address_of(pages_[number].buffer);
    ++loads_;
    return {};
}

/// The loaded page that was used longest ago, before `before`.
std::uint32_t PageCache::oldest(std::uint64_t before) const {
    std::uint32_t found = none;
    for (std::uint32_t i = 0; i < pages_.size(); ++i)
        if (pages_[i].buffer && pages_[i].last_use < before &&
            (found == none || pages_[i].last_use < pages_[found].last_use))
            found = i;
    return found;
}

void PageCache::release(std::uint32_t page) {
    pages_[page].buffer = {};
    entries_[page].data = {};
}

/// Loads a page in the place of others that were not used since `keep_since`.
Result<void> PageCache::fit_page(std::uint32_t page, std::uint64_t keep_since) {
    for (;;) {
        auto ok = load_page(page);
        if (ok || ok.error().code != ErrorCode::out_of_memory) return ok;
        const std::uint32_t victim = oldest(keep_since);
        if (victim == none) return ok;
        release(victim);
    }
}

Result<void> PageCache::load_all(std::uint64_t reserve, const Progress& progress) {
    for (std::uint32_t i = 0; i < plan_.size(); ++i) {
        if (progress.cancelled()) return cancelled();
        if (i > 0 && context_.memory().free() < Memory::cost(plan_[i].bytes()) + reserve) break;
        if (auto ok = load_page(i); !ok) {
            if (ok.error().code != ErrorCode::out_of_memory || i == 0) return ok;
            break;
        }
        progress("upload", static_cast<double>(i + 1) / static_cast<double>(plan_.size()));
    }
    return upload_table();
}

Result<std::vector<std::uint32_t>> PageCache::load(std::span<const std::uint32_t> wanted, const Progress& progress) {
    ++batch_;
    const std::uint64_t now = ++use_;
    std::vector<std::uint32_t> there, missing;
    for (const std::uint32_t page : wanted) {
        if (!is_loaded(page)) {
            missing.push_back(page);
            continue;
        }
        pages_[page].last_use = now;
        there.push_back(page);
    }
    for (const std::uint32_t page : missing) {
        if (progress.cancelled()) return cancelled();
        if (auto ok = fit_page(page, now); !ok) {
            if (ok.error().code == ErrorCode::out_of_memory && !there.empty()) break;
            static_cast<void>(upload_table()); // others have gone for it
            return ok.error();
        }
        pages_[page].last_use = now;
        there.push_back(page);
    }
    for (const std::uint32_t page : there) entries_[page].batch = batch_;
    if (auto ok = upload_table(); !ok) return ok.error();
    return there;
}

Result<bool> PageCache::release_one() {
    const std::uint32_t page = oldest(std::numeric_limits<std::uint64_t>::max());
    if (page == none) return false;
    release(page);
    if (auto ok = upload_table(); !ok) return ok.error();
    return true;
}

/// `from`   `components` words for each packed point
Result<void> PageCache::upload_points(const void* from, std::size_t components, std::uint32_t layout::Page::* place,
                                      const Progress& progress) {
    for (std::uint32_t i = 0; i < plan_.size(); ++i) {
        if (!is_loaded(i)) continue;
        if (progress.cancelled()) return cancelled();
        core::Buffer<std::uint32_t> words(components * plan_[i].points());
        fill_points(static_cast<const std::uint32_t*>(from), components, plan_[i], words.data());
        auto ok = context_.staging().upload(buffer(i), std::uint64_t{4} * (plan_[i].layout.*place),
                                            std::as_bytes(std::span(words.data(), words.size())));
        if (!ok) return ok;
        progress("upload", static_cast<double>(i + 1) / static_cast<double>(plan_.size()));
    }
    return {};
}

Result<void> PageCache::upload_values(const Progress& progress) {
    return upload_points(packed_->as<float>().values.data(), 1, &layout::Page::values, progress);
}

Result<void> PageCache::upload_gradients(const Progress& progress) {
    return upload_points(packed_->gradients.data(), 1, &layout::Page::gradients, progress);
}

Result<void> PageCache::upload_positions(const Progress& progress) {
    return upload_points(packed_->as<float>().positions.data(), 3, &layout::Page::positions, progress);
}

Result<void> PageCache::download_group_ranges(core::Packed& packed) const {
    for (std::uint32_t i = 0; i < plan_.size(); ++i) {
        if (!is_loaded(i)) continue;
        const std::span ranges(packed.group_ranges.data() + plan_[i].layout.first_group, plan_[i].groups);
        if (auto ok = context_.staging().download(buffer(i), std::uint64_t{4} * plan_[i].layout.group_ranges,
                                                  std::as_writable_bytes(ranges));
            !ok)
            return ok;
    }
    return {};
}

Result<void> PageCache::upload_table() { return resident_.upload_pages(context_, entries_); }

} // namespace isotet::vulkan
