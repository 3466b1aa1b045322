// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "render/volume/segments.hpp"

#include <algorithm>
#include <cmath>

#include "numbers/at_level.hpp"
#include "render/cpu/power_of_2.hpp"

namespace isotet::render {

namespace {

constexpr float deepest_piece =
    0.25F; ///< optical depth up to which the mean colour of a segment is right to half a grey level
constexpr int most_halvings = 12;
constexpr std::size_t most_ranked = 512;

/// What an optical depth hides: to its last digits where it is small, and 0 of 0.
float hidden_by(float depth) {
    if (depth < deepest_piece)
        return depth * (1 - depth * 0.5F * (1 - depth * (1 / 3.0F) * (1 - depth * 0.25F * (1 - depth * 0.2F))));
    return 1 - power_of_2(std::max(depth * -1.44269504F, -126.0F));
}

void add_piece(const Extinction& mean, float depth, float light, Slab& slab, RayState& ray) {
    const float hidden = hidden_by(depth), part = slab.through * hidden;
    const double of_mean = mean[0] > 0 ? static_cast<double>(part) / mean[0] : 0;
    for (std::size_t i = 0; i < 3; ++i) slab.light[i] += static_cast<float>(of_mean * mean[i + 1]) * light;
    slab.through -= part;
    ray.through -= ray.through * hidden;
    ray.done = ray.through < least_through;
}

/// Adds a segment between two sheets, the nearer half of what is too deep first.
void add_to_slab(float length, float from, float to, float light, const Transfer& transfer, Slab& slab, RayState& ray,
                 int halvings) {
    const Extinction mean = transfer.mean(from, to);
    const float depth = static_cast<float>(mean[0]) * length;
    if (!(depth > deepest_piece) || halvings == most_halvings) return add_piece(mean, depth, light, slab, ray);
    const float middle = 0.5F * (from + to);
    add_to_slab(0.5F * length, from, middle, light, transfer, slab, ray, halvings + 1);
    if (!ray.done) add_to_slab(0.5F * length, middle, to, light, transfer, slab, ray, halvings + 1);
}

/// Adds a segment, cut by the ends of the ray and by sheets.
void add_segment(const Segment& segment, const Medium& medium, RayState& ray) {
    const float light = static_cast<float>(segment.light) / Segment::full_light;
    if (segment.enter >= medium.enter && segment.leave <= medium.end && ray.stops.empty())
        return add_to_slab((segment.leave - segment.enter) * ray.lengths, segment.from, segment.to, light,
                           *medium.transfer, ray.slabs[0], ray, 0);
    const float begin = std::max(segment.enter, medium.enter), end = std::min(segment.leave, medium.end);
    if (!(begin < end)) return;
    const float slope = (segment.to - segment.from) / (segment.leave - segment.enter);
    const auto value_at = [&](float distance) { return segment.from + slope * (distance - segment.enter); };
    std::size_t slab = static_cast<std::size_t>(std::ranges::upper_bound(ray.stops, begin) - ray.stops.begin());
    for (float at = begin; at < end && !ray.done; ++slab) {
        const float next = slab < ray.stops.size() ? std::min(ray.stops[slab], end) : end;
        const float from = at == segment.enter ? segment.from : value_at(at),
                    to = next == segment.leave ? segment.to : value_at(next);
        add_to_slab((next - at) * ray.lengths, from, to, light, *medium.transfer, ray.slabs[slab], ray, 0);
        at = next;
    }
}

/// By counting, for each segment, how many come before: all at once, without branches.
void sort_by_ranks(std::span<const Segment> segments, std::vector<Segment>& sorted) {
    std::array<float, most_ranked> enters;
    std::array<std::int32_t, most_ranked> ranks;
    const auto count = static_cast<std::int32_t>(segments.size());
    for (std::int32_t i = 0; i < count; ++i) {
        enters[static_cast<std::size_t>(i)] = segments[static_cast<std::size_t>(i)].enter;
        ranks[static_cast<std::size_t>(i)] = 0;
    }
    for (std::int32_t i = 0; i < count; ++i) {
        const float enter = enters[static_cast<std::size_t>(i)];
        for (std::int32_t j = 0; j < count; ++j) {
            const float other = enters[static_cast<std::size_t>(j)];
            ranks[static_cast<std::size_t>(j)] +=
                static_cast<std::int32_t>(enter < other) |
                (static_cast<std::int32_t>(enter == other) & static_cast<std::int32_t>(i < j));
        }
    }
    for (std::size_t i = 0; i < segments.size(); ++i) sorted[static_cast<std::size_t>(ranks[i])] = segments[i];
    // Of equal beginnings: by all numbers, in whatever order they came.
    for (std::size_t i = 1; i < segments.size(); ++i)
        for (std::size_t k = i; k > 0 && sorted[k].enter == sorted[k - 1].enter && sorted[k] < sorted[k - 1]; --k)
            std::swap(sorted[k], sorted[k - 1]);
}

} // namespace

void SegmentLists::clear() {
    counts_.fill(0);
    for (const auto& [pixel, larger] : grown_) lists_[pixel] = {memory_.get() + pixel * room_.capacity, room_.capacity};
    grown_.clear();
}

void SegmentLists::grow(std::size_t pixel) {
    List& list = lists_[pixel];
    auto larger = std::make_unique_for_overwrite<Segment[]>(std::size_t{2} * list.capacity);
    std::copy_n(list.data, list.capacity, larger.get());
    list = {larger.get(), 2 * list.capacity};
    const auto same = std::ranges::find(grown_, pixel, [](const auto& one) { return one.first; });
    if (same != grown_.end()) same->second = std::move(larger);
    else grown_.emplace_back(pixel, std::move(larger));
    std::uint64_t bytes = 0;
    for (const auto& [which, memory] : grown_) bytes += sizeof(Segment) * lists_[which].capacity;
    grown_bytes_ = std::max(grown_bytes_, bytes);
}

std::size_t compose(std::span<Segment> segments, float horizon, std::span<const Medium> media, RayState& ray,
                    std::vector<Segment>& scratch) {
    if (scratch.size() < segments.size()) scratch.resize(segments.size());
    std::size_t next = 0;
    core::at_level([&] {
        if (segments.size() <= most_ranked) {
            sort_by_ranks(segments, scratch);
        } else {
            std::ranges::copy(segments, scratch.begin());
            std::sort(scratch.begin(), scratch.begin() + static_cast<std::ptrdiff_t>(segments.size()));
        }
        for (; next < segments.size() && scratch[next].enter < horizon && !ray.done; ++next)
            add_segment(scratch[next], media[scratch[next].volume], ray);
    });
    if (ray.done) return 0;
    std::copy(scratch.begin() + static_cast<std::ptrdiff_t>(next),
              scratch.begin() + static_cast<std::ptrdiff_t>(segments.size()), segments.begin());
    return segments.size() - next;
}

} // namespace isotet::render
