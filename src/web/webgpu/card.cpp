// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "card.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdlib>
#include <limits>
#include <utility>

#include "api/engines.hpp"
#include "api/finish.hpp"
#include "api/fits.hpp"
#include "api/ties.hpp"
#include "push.h"
#include "vulkan/engine/layout.hpp"

namespace isotet::web {

namespace {

namespace layout = vulkan::layout;

/// At the front of the state: two lists of clusters, as layout::ListHead, then eight words that tell of the surface.
constexpr std::uint32_t head_words = 16;

/// Whether so many bytes can be had, and a little more: where they cannot, taking them ends the module.
bool is_there_room(std::uint64_t bytes) {
    const std::uint64_t wanted = bytes + (std::uint64_t{1} << 20);
    if (wanted > std::numeric_limits<std::size_t>::max()) return false;
    void* const volatile room = std::malloc(wanted); // volatile: compilers leave out what is only given back
    std::free(room);
    return room != nullptr;
}

struct Push {
#define ISOTET_FLOAT(name) float name;
#define ISOTET_UINT(name) std::uint32_t name;
    ISOTET_CARD_PUSH(ISOTET_FLOAT, ISOTET_UINT)
#undef ISOTET_FLOAT
#undef ISOTET_UINT
};
constexpr std::size_t push_size = sizeof(Push) / 4;

bool is_same(const core::StoredIsovalue<float>& a, const core::StoredIsovalue<float>& b) {
    return a.value == b.value && a.rest == b.rest && a.tied == b.tied;
}

view::Json place_of(const void* data, std::size_t bytes) { return {reinterpret_cast<std::uintptr_t>(data), bytes}; }

/// By the card what it takes, from the second call for a grid on.
Result<std::vector<Extraction>> extract_by_card(const PackedGrid& packed, std::span<const double> isovalues,
                                                const ExtractOptions& options, const Run& run) {
    if (!card().takes(packed, isovalues.size(), options) || card().is_new(packed))
        return isotet::extract(packed, isovalues, options, run);
    Result<Extraction> made = card().extract(packed, isovalues.front(), options);
    if (!made) return made.error();
    std::vector<Extraction> all;
    all.push_back(*std::move(made));
    return all;
}

} // namespace

Card& card() {
    static Card one;
    return one;
}

std::shared_ptr<const Engine> card_engine() {
    static const auto engine = api::engine_in_memory(cpu_engine()->name(), extract_by_card, extract_direct);
    return engine;
}

void Card::turn_on(std::uint64_t binding_bytes, std::uint32_t groups_per_axis) {
    *this = {};
    on_ = true;
    binding_bytes_ = binding_bytes;
    groups_per_axis_ = groups_per_axis;
}

void Card::turn_off() {
    const std::uint32_t number = number_;
    *this = {};
    number_ = number;
}

Card::Asking::~Asking() {
    card_.may_ask_ = false;
    if (!card_.asked_of_) card_.made_.clear();
}

bool Card::takes(const PackedGrid& packed, std::size_t isovalues, const ExtractOptions& options) const {
    const core::Packed& grid = packed.data();
    const bool is_plain = options.normals != Normals::gradient && !options.edge_ends && !options.source_cells &&
                          options.point_fields.empty() && options.packed_fields.empty() &&
                          options.cell_fields.empty() && !options.sink;
    return on_ && may_ask_ && isovalues == 1 && is_plain && grid.single() && !grid.residency && grid.clusters() > 0 &&
           too_large_.lock() != packed.shared_data();
}

bool Card::is_new(const PackedGrid& packed) {
    if (seen_.lock() != packed.shared_data()) {
        seen_ = packed.shared_data();
        seen_first_ = calls_;
    }
    return seen_first_ == calls_;
}

/// Where all lies on the card. Whether it fits there, and what goes there fits here.
bool Card::plan(const core::Packed& packed) {
    std::vector<vulkan::PlannedPage> pages = vulkan::plan_pages(packed, vulkan::max_page_bytes);
    if (pages.size() != 1) return false;
    page_ = std::move(pages.front());
    const std::uint64_t clusters = packed.clusters();
    const std::uint64_t segments = (clusters + layout::segment_clusters - 1) / layout::segment_clusters,
                        blocks = (segments + layout::block_segments - 1) / layout::block_segments;
    std::uint64_t words = head_words, all_masks = 0;
    for (const core::ClusterHeader& header : packed.headers) all_masks += vulkan::mask_words_of(header);
    const auto place = [&](std::uint32_t& at, std::uint64_t count) {
        at = static_cast<std::uint32_t>(words);
        words += count;
    };
    place(places_.counts, 2 * clusters);
    place(places_.segments, 2 * segments);
    place(places_.blocks, 2 * blocks);
    place(places_.starts, 3 * clusters);
    place(places_.selected, clusters);
    place(places_.emitted, clusters);
    place(places_.masks, all_masks);
    const std::uint64_t largest =
        std::max({page_.bytes(), 4 * words, clusters * sizeof(layout::Cluster), std::uint64_t{4096}});
    places_.all = static_cast<std::uint32_t>(words);
    return largest <= binding_bytes_ && is_there_room(page_.bytes() + clusters * sizeof(layout::Cluster));
}

void Card::fill(const core::Packed& packed) {
    clusters_.resize(packed.clusters());
    vulkan::place_clusters(packed, page_, 0, clusters_.data());
    vulkan::number_masks(packed, clusters_.data());
    page_words_ = core::Buffer<std::uint32_t>(page_.words);
    vulkan::fill_page(packed, page_, clusters_.data(), page_words_.data());
    tables_.assign(layout::cell_cases.begin(), layout::cell_cases.end());
    places_.clusters_without_data = static_cast<std::uint32_t>(tables_.size());
    tables_.resize(tables_.size() + (packed.clusters() + 31) / 32);
    for (std::size_t c = 0; c < packed.clusters(); ++c)
        tables_[places_.clusters_without_data + c / 32] |= std::uint32_t{packed.has_no_data[c]} << c % 32;
}

void Card::release_upload() {
    page_words_.release();
    clusters_ = {};
    tables_ = {};
}

/// Whether the grid is on the card, or goes there with what is asked for next.
bool Card::can_have(const std::shared_ptr<const core::Packed>& packed) {
    if (there_.lock() == packed) return true;
    if (too_large_.lock() == packed) return false;
    there_.reset();
    release_upload();
    if (!plan(*packed)) {
        too_large_ = packed;
        return false;
    }
    fill(*packed);
    there_ = packed;
    ++number_;
    return true;
}

Result<Extraction> Card::extract(const PackedGrid& packed, double isovalue, const ExtractOptions& options) {
    if (auto ok = api::check_isovalues({&isovalue, 1}); !ok) return ok.error();
    if (auto ok = api::check_fit(options, packed.data()); !ok) return ok.error();
    const core::Packed& grid = packed.data();
    const auto stored = core::store_isovalue<float>(isovalue, grid.storage);
    const auto found = std::find_if(made_.begin(), made_.end(), [&](const Made& one) {
        return one.packed == &grid && one.ties == options.ties && is_same(one.isovalue, stored);
    });
    if (found == made_.end()) {
        if (!can_have(packed.shared_data())) return isotet::extract(packed, isovalue, options, {1, {}});
        asked_of_ = packed.shared_data();
        asked_ = stored;
        asked_ties_ = options.ties;
        is_handed_out_ = false;
        return Error{ErrorCode::cancelled, "the graphics card works on this surface"};
    }
    ops::RawSurface raw;
    raw.positions = found->positions;
    raw.triangles = found->triangles;
    Extraction out;
    out.surface = api::finish<float>({grid.origin, grid.point_type}, options, {}, raw);
    const auto told = api::report_ties(grid, isovalue, stored, found->tied_points, out.report, {});
    if (!told) return told.error();
    out.report.selected_clusters = found->selected_clusters;
    out.report.surface_bytes = api::bytes_of(out.surface);
    return out;
}

std::vector<std::uint32_t> Card::push_words() const {
    const layout::Page& at = page_.layout;
    bool with_others = false;
    for (const core::ClusterHeader& header : asked_of_->headers) with_others |= header.others() != 0;
    Push push{};
    push.isovalue = asked_.value;
    push.rest = asked_.rest;
    push.tied = asked_.tied;
    push.merge = asked_ties_ == Ties::merge;
    push.cluster_count = static_cast<std::uint32_t>(asked_of_->clusters());
    push.groups_per_axis = groups_per_axis_;
    push.any_no_data = asked_of_->field_report.no_data > 0;
    push.with_others = with_others;
    push.values = at.values;
    push.places = at.positions;
    push.cells = at.cells;
    push.group_ranges = at.group_ranges;
    push.links = at.links;
    push.clusters_without_data = places_.clusters_without_data;
    push.counts = places_.counts;
    push.segments = places_.segments;
    push.blocks = places_.blocks;
    push.starts = places_.starts;
    push.selected = places_.selected;
    push.emitted = places_.emitted;
    push.masks = places_.masks;
    const auto words = std::bit_cast<std::array<std::uint32_t, push_size>>(push);
    return {words.begin(), words.end()};
}

std::optional<view::Json> Card::wanted() {
    if (!asked_of_ || is_handed_out_) return std::nullopt;
    is_handed_out_ = true;
    view::Json wanted = {
        {"grid", number_},
        {"push", push_words()},
        {"clusters", asked_of_->clusters()},
        {"stateBytes", std::uint64_t{4} * places_.all},
        {"segments", (asked_of_->clusters() + layout::segment_clusters - 1) / layout::segment_clusters}};
    if (!page_words_.empty()) {
        const auto& ranges = asked_of_->as<float>().ranges;
        wanted["upload"] = {place_of(page_words_.data(), page_words_.bytes()),
                            place_of(clusters_.data(), clusters_.size() * sizeof(layout::Cluster)),
                            place_of(ranges.data(), ranges.size() * sizeof(core::Range<float>)),
                            place_of(tables_.data(), 4 * tables_.size())};
    }
    return wanted;
}

void Card::leave() {
    too_large_ = std::exchange(asked_of_, nullptr);
    there_.reset();
    release_upload();
}

view::Json Card::measure(double part, bool by_card) {
    const std::shared_ptr<const core::Packed> there = seen_.lock();
    if (!there || there == too_large_.lock()) return nullptr;
    const FieldReport& field = there->field_report;
    const double isovalue = field.lower + part * (field.upper - field.lower);
    const PackedGrid packed(there);
    const Asking asking(*this);
    const Result<Extraction> made =
        by_card ? extract(packed, isovalue, {}) : isotet::extract(packed, isovalue, {}, {1, {}});
    if (!made) return nullptr;
    const Surface& surface = made->surface;
    return {
        {"isovalue", isovalue}, {"vertices", surface.positions.tuples()}, {"triangles", surface.triangles.tuples()}};
}

view::Json Card::room_for(std::uint32_t vertices, std::uint32_t triangles, std::uint32_t tied_points,
                          std::uint32_t selected_clusters) {
    release_upload(); // it is there
    if (!is_there_room(12 * (std::uint64_t{vertices} + triangles))) return nullptr;
    core::SharedBuffer<float> positions(3 * std::size_t{vertices});
    core::SharedBuffer<std::uint32_t> corners(3 * std::size_t{triangles});
    const view::Json room = {{"positions", reinterpret_cast<std::uintptr_t>(positions.data())},
                             {"triangles", reinterpret_cast<std::uintptr_t>(corners.data())}};
    made_.push_back({asked_of_.get(), asked_, asked_ties_, std::move(positions).to_array(3),
                     std::move(corners).to_array(3), tied_points, selected_clusters});
    asked_of_.reset();
    return room;
}

} // namespace isotet::web
