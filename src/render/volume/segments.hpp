// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What rays meet in tets: a list a pixel, which is sorted and composed as far as nothing can come before.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <tuple>
#include <vector>

#include "render/color/linear_light.hpp"
#include "render/volume/transfer.hpp"

namespace isotet::render {

/// The way of a ray through a tet: its ends, as distances, and places in the transfer table there.
struct Segment {
    float enter, leave, from, to;
    std::uint16_t light = full_light; ///< of the colour
    std::uint16_t volume = 0;

    static constexpr std::uint16_t full_light = 65535;

    auto key() const { return std::tie(enter, leave, from, to, light, volume); }
    friend bool operator<(const Segment& a, const Segment& b) { return a.key() < b.key(); }
};

/// How lists are kept; tests change it.
struct ListRoom {
    std::uint32_t capacity = 128;    ///< of a list before it grows
    std::uint32_t compose_from = 64; ///< segments
};

/// The segments of the pixels of a tile. A full list grows.
class SegmentLists {
public:
    static constexpr std::size_t pixels = 1024;

    explicit SegmentLists(const ListRoom& room)
        : room_(room), memory_(std::make_unique_for_overwrite<Segment[]>(pixels * room.capacity)) {
        for (std::size_t i = 0; i < pixels; ++i) lists_[i] = {memory_.get() + i * room.capacity, room.capacity};
    }

    void add(std::size_t pixel, const Segment& segment) {
        if (counts_[pixel] == lists_[pixel].capacity) grow(pixel);
        lists_[pixel].data[counts_[pixel]++] = segment;
    }
    std::span<Segment> of(std::size_t pixel) { return {lists_[pixel].data, counts_[pixel]}; }
    std::uint32_t count(std::size_t pixel) const { return counts_[pixel]; }
    void set_count(std::size_t pixel, std::size_t count) { counts_[pixel] = static_cast<std::uint32_t>(count); }

    /// Empties all, and gives back what grew.
    void clear();
    std::uint64_t bytes() const { return sizeof(Segment) * pixels * room_.capacity + grown_bytes_; } ///< most so far

private:
    struct List {
        Segment* data = nullptr;
        std::uint32_t capacity = 0;
    };
    void grow(std::size_t pixel);

    ListRoom room_;
    std::unique_ptr<Segment[]> memory_;
    std::array<List, pixels> lists_;
    std::array<std::uint32_t, pixels> counts_{};
    std::vector<std::pair<std::size_t, std::unique_ptr<Segment[]>>> grown_;
    std::uint64_t grown_bytes_ = 0;
};

/// A part of a ray between two sheets.
struct Slab {
    Light light{}; ///< that comes out of it in front
    float through = 1;
};

/// How a ray is composed.
struct RayState {
    float lengths = 1;  ///< of the user, for 1 of distance
    float through = 1;  ///< of all so far
    bool done = false;  ///< nothing more is seen
    std::span<const float> stops; ///< distances of sheets, ascending
    std::span<Slab> slabs;        ///< one more than stops
};

/// A scene has no more volumes.
inline constexpr std::size_t most_volumes = 65536;

inline constexpr float least_through = 0.002F; ///< less is nothing

/// A volume along one ray.
struct Medium {
    const Transfer* transfer = nullptr;
    float enter = 0, end = 0; ///< distances between which segments count
};

/// Sorts segments, and composes those that begin before `horizon`; the others stay in front. Returns how many stay.
/// `media`   of each volume
std::size_t compose(std::span<Segment> segments, float horizon, std::span<const Medium> media, RayState& ray,
                    std::vector<Segment>& scratch);

} // namespace isotet::render
