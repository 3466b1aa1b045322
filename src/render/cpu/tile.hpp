// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Drawing one tile of a picture: a depth buffer of samples for what is opaque, lists of fragments for what is not, then
// the mean of the samples of each pixel.
#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <isotet/picture.hpp>

#include "render/cpu/bins.hpp"
#include "render/cpu/encode.hpp"
#include "render/cpu/occlusion.hpp"
#include "render/cpu/raster.hpp"
#include "render/cpu/shade.hpp"
#include "render/volume/volume_tile.hpp"

namespace isotet::render {

/// How far a tile is drawn: to rays that are given to a batch, which seeks isosurfaces or media; or as a whole.
enum class TileStage : std::uint8_t { to_hits, to_media, whole };

/// What all tiles of a picture share.
struct TileScene {
    const std::vector<Sheet>& sheets;
    Screen screen;
    Tiling tiling;
    Light background{};
    float background_opacity = 1;
    LightBytes bytes;
    const VolumeScene* volumes = nullptr; ///< or null
    const Occlusion* occlusion = nullptr; ///< or null
    float occlusion_strength = 0;
    RayBatch* batch = nullptr; ///< of rays that something else follows; null: tiles do
    TileStage stage = TileStage::whole;
};

class Tile {
public:
    explicit Tile(const TileScene& scene);

    /// Draws the tile of this number into the picture. `entries`: what is opaque comes before what is translucent.
    /// In a stage before the last the picture stays as it is.
    void draw(std::size_t number, std::span<const BinEntry> entries, Picture& picture);

    VolumeWork volume_work() const { return volumes_ ? volumes_->work() : VolumeWork(); } ///< of all tiles so far

private:
    /// A triangle, or the piece of one that is in view, which covers samples of the tile.
    struct Facet {
        const Sheet* sheet;
        std::uint32_t triangle;
        DepthPlane depth;

        bool is_before(const Facet& other) const {
            return sheet != other.sheet ? sheet < other.sheet : triangle < other.triangle;
        }
    };
    /// Samples of a pixel that a translucent facet covers.
    struct Fragment {
        std::uint32_t facet, next; ///< next: 1 + the fragment, or 0
        SampleMask mask;
    };
    /// What is seen of a facet in a pixel.
    struct Part {
        std::uint32_t facet;
        SampleMask mask;
    };
    /// The parts in a pixel: opaque ones from `first` on, then translucent ones, as in the list of fragments.
    struct PixelParts {
        std::size_t first, translucent, end;
    };
    struct DepthRange {
        float nearest, farthest;
    };
    /// A fragment in front of the others, or behind them.
    struct Layer {
        float depth, per_x, per_y, lower, upper; ///< at the middle of the pixel; a sample
        float reach;                             ///< how far samples differ
        SampleMask mask;
        Shade shade;
    };
    struct Blend {
        Light light{}; ///< times opacity
        float opacity = 0;

        void add_behind(const Light& color, float its_opacity) {
            const float part = (1 - opacity) * its_opacity;
            for (std::size_t i = 0; i < 3; ++i) light[i] += part * color[i];
            opacity += part;
        }
        void divide_by(std::uint32_t samples) {
            const float part = 1 / static_cast<float>(samples);
            for (float& component : light) component *= part;
            opacity *= part;
        }
    };

    void draw_all(std::size_t number, std::span<const BinEntry> entries, Picture& picture);
    void start(std::size_t number);
    void add(const BinEntry& entry);
    void add_facet(const Sheet& sheet, std::uint32_t triangle, const FixedPoint& a, const FixedPoint& b,
                   const FixedPoint& c);
    bool may_be_seen(float nearest);
    void measure_opaque();
    static DepthRange range_of(std::span<const float> depths);
    void cover(std::uint32_t facet, std::size_t pixel, float depth, SampleMask mask);
    SampleMask in_front(const Facet& facet, std::size_t pixel, float depth, SampleMask mask) const;
    void shade_row(std::int32_t y);
    void add_part(std::uint32_t facet, std::int32_t x, std::int32_t y, SampleMask mask);
    Light opaque_color(const Facet& facet, const Light& shade, std::int32_t x, std::int32_t y) const;
    Blend resolve(std::int32_t x, std::int32_t y);
    void follow_rays();
    void give_rays();
    void end_rays();
    void cut_rays();
    void take_sheet_distances(std::int32_t x, std::int32_t y, std::size_t ray);
    Blend blend_ray(std::int32_t x, std::int32_t y);
    Blend blend_sample(std::uint32_t sample, float end, std::size_t ray, const RayHit& hit) const;
    float distance_of(float depth) const { return static_cast<float>(scene_.volumes->rays.distance(double{depth})); }
    float depth_in_middle(const DepthPlane& plane, std::int32_t x, std::int32_t y) const {
        const double middle = 0.5 * (scene_.screen.samples - 1);
        return static_cast<float>(plane.at_first + (x * frame_.samples + middle) * plane.per_x +
                                  (y * frame_.samples + middle) * plane.per_y);
    }
    std::size_t pixel_of(std::int32_t x, std::int32_t y) const {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(frame_.width) + static_cast<std::size_t>(x);
    }
    void take_opaque(std::int32_t x, std::int32_t y);
    void take_layers(std::int32_t x, std::int32_t y);
    Blend blend_whole() const;
    bool have_samples_of_their_own() const;
    Blend blend_apart() const;
    Blend blend_samples();

    const TileScene& scene_;
    TileFrame frame_;
    std::uint32_t count_; ///< samples a pixel
    SampleMask all_;
    std::vector<float> right_, down_; ///< of each sample, from the middle of its pixel
    std::vector<Facet> facets_;
    std::vector<Fragment> fragments_;
    std::vector<float> depths_;         ///< of the nearest opaque facet a sample
    std::vector<DepthRange> ranges_;    ///< of the depths of a pixel, once all that is opaque is there
    float farthest_ = INFINITY;         ///< of all, or more while what is opaque is drawn
    std::size_t until_measured_ = 0;    ///< opaque triangles until farthest_ is found again
    std::vector<std::uint32_t> owners_; ///< 1 + that facet, or 0
    std::vector<std::uint32_t> heads_;  ///< 1 + the last fragment of a pixel, or 0
    std::vector<std::uint8_t> covered_; ///< whether a pixel has anything opaque

    // Of the row that is resolved:
    std::vector<Part> parts_;
    std::vector<ShadedPlace> places_; ///< of each part
    std::vector<Shade> shades_;
    std::vector<PixelParts> row_;

    // Of the pixel that is resolved:
    std::vector<Layer> layers_;
    std::vector<std::pair<float, const Layer*>> order_;
    std::vector<Blend> opaque_; ///< a sample
    Blend mean_opaque_;

    std::unique_ptr<VolumeTile> volumes_; ///< where the scene has some
    std::vector<float> distances_;        ///< of the sheets of a pixel
};

} // namespace isotet::render
