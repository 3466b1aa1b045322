// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "render/cpu/tile.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <span>
#include <tuple>

#include "numbers/at_level.hpp"
#include "render/cpu/clip.hpp"

namespace isotet::render {

namespace {

constexpr float opaque_enough = 0.998F;     ///< nothing is seen behind
constexpr std::size_t samples_together = 4; ///< samples that are compared together

/// Of values none of which is NaN, in as many lanes as a processor may have.
float greatest_of(std::span<const float> values) {
    std::array<float, 32> greatest;
    greatest.fill(-INFINITY);
    std::size_t i = 0;
    for (; i + greatest.size() <= values.size(); i += greatest.size())
        for (std::size_t k = 0; k < greatest.size(); ++k)
            greatest[k] = values[i + k] > greatest[k] ? values[i + k] : greatest[k];
    for (; i < values.size(); ++i) greatest[0] = std::max(greatest[0], values[i]);
    return std::ranges::max(greatest);
}

/// The samples of a plane that lie before some depths, and those that lie as deep. As many of `right`, `down` and `depths`
/// are read as there are samples, rounded up to a multiple of 4.
struct Compared {
    SampleMask before = 0, equal = 0;
};
Compared compare_depths(const DepthPlane& plane, float middle, const float* right, const float* down,
                        const float* depths, std::size_t samples) {
    const auto per_x = static_cast<float>(plane.per_x), per_y = static_cast<float>(plane.per_y);
    Compared found;
#if defined(__SSE2__)
    const __m128 x = _mm_set1_ps(per_x), y = _mm_set1_ps(per_y), at_middle = _mm_set1_ps(middle);
    const __m128 lower = _mm_set1_ps(plane.lower), upper = _mm_set1_ps(plane.upper);
    for (std::size_t i = 0; i < samples; i += samples_together) {
        const __m128 across = _mm_add_ps(at_middle, _mm_mul_ps(x, _mm_loadu_ps(right + i)));
        const __m128 anywhere = _mm_add_ps(across, _mm_mul_ps(y, _mm_loadu_ps(down + i)));
        const __m128 at = _mm_min_ps(_mm_max_ps(anywhere, lower), upper), others = _mm_loadu_ps(depths + i);
        found.before |= static_cast<SampleMask>(_mm_movemask_ps(_mm_cmplt_ps(at, others))) << i;
        found.equal |= static_cast<SampleMask>(_mm_movemask_ps(_mm_cmpeq_ps(at, others))) << i;
    }
#else
    for (std::size_t i = 0; i < samples; ++i) {
        const float at = std::clamp(middle + per_x * right[i] + per_y * down[i], plane.lower, plane.upper);
        found.before |= SampleMask{at < depths[i]} << i;
        found.equal |= SampleMask{at == depths[i]} << i;
    }
#endif
    return found;
}

/// Gives the samples of a mask the depth of a plane, and an owner; reads, and writes as they are, as many as
/// compare_depths() reads.
void cover_samples(const DepthPlane& plane, float middle, const float* right, const float* down, SampleMask mask,
                   std::uint32_t owner, float* depths, std::uint32_t* owners, std::size_t samples) {
    const auto per_x = static_cast<float>(plane.per_x), per_y = static_cast<float>(plane.per_y);
#if defined(__SSE2__)
    const __m128 x = _mm_set1_ps(per_x), y = _mm_set1_ps(per_y), at_middle = _mm_set1_ps(middle);
    const __m128 lower = _mm_set1_ps(plane.lower), upper = _mm_set1_ps(plane.upper);
    const __m128i bits = _mm_setr_epi32(1, 2, 4, 8), new_owner = _mm_set1_epi32(static_cast<int>(owner));
    for (std::size_t i = 0; i < samples; i += samples_together) {
        const auto some = static_cast<int>(mask >> i & 15);
        if (some == 0) continue;
        const __m128 across = _mm_add_ps(at_middle, _mm_mul_ps(x, _mm_loadu_ps(right + i)));
        const __m128 anywhere = _mm_add_ps(across, _mm_mul_ps(y, _mm_loadu_ps(down + i)));
        const __m128 at = _mm_min_ps(_mm_max_ps(anywhere, lower), upper);
        const __m128i chosen = _mm_cmpeq_epi32(_mm_and_si128(_mm_set1_epi32(some), bits), bits);
        const __m128 chosen_depths = _mm_castsi128_ps(chosen);
        _mm_storeu_ps(depths + i,
                      _mm_or_ps(_mm_and_ps(chosen_depths, at), _mm_andnot_ps(chosen_depths, _mm_loadu_ps(depths + i))));
        auto* const own = reinterpret_cast<__m128i*>(owners + i);
        _mm_storeu_si128(
            own, _mm_or_si128(_mm_and_si128(chosen, new_owner), _mm_andnot_si128(chosen, _mm_loadu_si128(own))));
    }
#else
    for (std::size_t i = 0; i < samples; ++i) {
        if (!(mask >> i & 1)) continue;
        depths[i] = std::clamp(middle + per_x * right[i] + per_y * down[i], plane.lower, plane.upper);
        owners[i] = owner;
    }
#endif
}

/// The samples that one facet has, likewise; bits behind the last may be set.
SampleMask samples_of(std::uint32_t owner, const std::uint32_t* owners, std::size_t samples) {
    SampleMask mask = 0;
#if defined(__SSE2__)
    const __m128i wanted = _mm_set1_epi32(static_cast<int>(owner));
    for (std::size_t i = 0; i < samples; i += samples_together) {
        const __m128i own = _mm_loadu_si128(reinterpret_cast<const __m128i*>(owners + i));
        mask |= static_cast<SampleMask>(_mm_movemask_ps(_mm_castsi128_ps(_mm_cmpeq_epi32(own, wanted)))) << i;
    }
#else
    for (std::size_t i = 0; i < samples; ++i) mask |= SampleMask{owners[i] == owner} << i;
#endif
    return mask;
}

} // namespace

Tile::Tile(const TileScene& scene)
    : scene_(scene), count_(scene.screen.samples * scene.screen.samples), all_(first_samples(count_)) {
    const std::uint32_t s = scene.screen.samples;
    right_.resize((count_ + samples_together - 1) / samples_together * samples_together);
    down_.resize(right_.size());
    for (std::uint32_t i = 0; i < count_; ++i) {
        right_[i] = static_cast<float>(i % s) - 0.5F * static_cast<float>(s - 1);
        down_[i] = static_cast<float>(i / s) - 0.5F * static_cast<float>(s - 1);
    }
    opaque_.resize(count_);
    if (scene.volumes) volumes_ = std::make_unique<VolumeTile>(*scene.volumes, !scene.batch);
}

void Tile::draw(std::size_t number, std::span<const BinEntry> entries, Picture& picture) {
    core::at_level([&] { draw_all(number, entries, picture); });
}

void Tile::draw_all(std::size_t number, std::span<const BinEntry> entries, Picture& picture) {
    start(number);
    bool measured = false;
    for (const BinEntry& entry : entries) {
        if (!measured && scene_.sheets[entry.sheet].translucent) {
            measure_opaque();
            measured = true;
        }
        if (measured || may_be_seen(entry.nearest)) add(entry);
    }
    if (scene_.batch && scene_.stage != TileStage::whole) return give_rays();
    if (volumes_) follow_rays();
    const auto s = static_cast<std::int64_t>(scene_.screen.samples);
    for (std::int32_t y = 0; y < frame_.height; ++y) {
        shade_row(y);
        for (std::int32_t x = 0; x < frame_.width; ++x) {
            Blend sum = volumes_ ? blend_ray(x, y) : resolve(x, y);
            sum.add_behind(scene_.background, scene_.background_opacity);
            std::array<std::uint8_t, 4>& pixel =
                picture.pixels[static_cast<std::size_t>((frame_.y / s + y) * picture.width + frame_.x / s + x)];
            pixel = {};
            if (!(sum.opacity > 0)) continue;
            for (std::size_t i = 0; i < 3; ++i) pixel[i] = scene_.bytes.of(sum.light[i] / sum.opacity);
            pixel[3] = static_cast<std::uint8_t>(std::min(sum.opacity, 1.0F) * 255 + 0.5F);
        }
    }
}

void Tile::start(std::size_t number) {
    const Tiling& tiling = scene_.tiling;
    const std::uint32_t column = static_cast<std::uint32_t>(number % tiling.columns()) * tiling.side,
                        row = static_cast<std::uint32_t>(number / tiling.columns()) * tiling.side;
    frame_ = {std::int64_t{column} * tiling.samples, std::int64_t{row} * tiling.samples,
              static_cast<std::int32_t>(std::min(tiling.side, tiling.width - column)),
              static_cast<std::int32_t>(std::min(tiling.side, tiling.height - row)),
              static_cast<std::int32_t>(tiling.samples)};
    const std::size_t pixels = static_cast<std::size_t>(frame_.width) * static_cast<std::size_t>(frame_.height);
    facets_.clear();
    farthest_ = INFINITY;
    until_measured_ = 0;
    if (volumes_) volumes_->start(number, column, row);
    fragments_.clear();
    depths_.assign(pixels * count_ + samples_together - 1, INFINITY);
    owners_.assign(depths_.size(), 0);
    heads_.assign(pixels, 0);
    covered_.assign(pixels, 0);
}

void Tile::add(const BinEntry& entry) {
    const Sheet& sheet = scene_.sheets[entry.sheet];
    const FixedPolygon polygon = polygon_of(sheet, entry.triangle, scene_.screen.sight);
    for (std::size_t i = 2; i < polygon.count; ++i)
        add_facet(sheet, entry.triangle, polygon.points[0], polygon.points[i - 1], polygon.points[i]);
}

void Tile::add_facet(const Sheet& sheet, std::uint32_t triangle, const FixedPoint& a, const FixedPoint& b,
                     const FixedPoint& c) {
    if (sheet.translucent && std::min({a.depth, b.depth, c.depth}) >= farthest_) return;
    const TileCover samples(a, b, c, frame_);
    const auto number = static_cast<std::uint32_t>(facets_.size());
    const double middle = 0.5 * (scene_.screen.samples - 1);
    samples.each_pixel([&](std::int32_t x, std::int32_t y, SampleMask mask) {
        if (facets_.size() == number) facets_.push_back({&sheet, triangle, DepthPlane(a, b, c, frame_)});
        const DepthPlane& plane = facets_[number].depth;
        const auto depth = static_cast<float>(plane.at_first + (x * frame_.samples + middle) * plane.per_x +
                                              (y * frame_.samples + middle) * plane.per_y);
        cover(number,
              static_cast<std::size_t>(y) * static_cast<std::size_t>(frame_.width) + static_cast<std::size_t>(x), depth,
              mask);
    });
}

/// Of an opaque triangle, and of all that come after it.
bool Tile::may_be_seen(float nearest) {
    constexpr std::size_t triangles_between = 64; // a look at all samples takes as long as a few triangles
    if (until_measured_-- == 0) {
        until_measured_ = triangles_between;
        const bool all = std::memchr(covered_.data(), 0, covered_.size()) == nullptr;
        farthest_ = all ? greatest_of(std::span(depths_).first(covered_.size() * count_)) : INFINITY;
    }
    return nearest <= farthest_; // of those at the same depth the first one is seen, in the order of sheets
}

Tile::DepthRange Tile::range_of(std::span<const float> depths) {
    DepthRange range{depths[0], depths[0]};
    std::size_t i = 0;
#if defined(__SSE2__)
    if (depths.size() >= samples_together) {
        __m128 nearest = _mm_loadu_ps(depths.data()), farthest = nearest;
        for (i = samples_together; i + samples_together <= depths.size(); i += samples_together) {
            const __m128 some = _mm_loadu_ps(depths.data() + i);
            nearest = _mm_min_ps(nearest, some);
            farthest = _mm_max_ps(farthest, some);
        }
        std::array<float, samples_together> low, high;
        _mm_storeu_ps(low.data(), nearest);
        _mm_storeu_ps(high.data(), farthest);
        range = {std::ranges::min(low), std::ranges::max(high)};
    }
#endif
    for (; i < depths.size(); ++i) range = {std::min(range.nearest, depths[i]), std::max(range.farthest, depths[i])};
    return range;
}

/// What is translucent need not be compared sample by sample where all of it is in front of the opaque, or behind.
void Tile::measure_opaque() {
    ranges_.resize(covered_.size());
    farthest_ = 0;
    for (std::size_t pixel = 0; pixel < ranges_.size(); ++pixel) {
        ranges_[pixel] = covered_[pixel] ? range_of(std::span(depths_).subspan(pixel * count_, count_))
                                         : DepthRange{INFINITY, INFINITY};
        farthest_ = std::max(farthest_, ranges_[pixel].farthest);
    }
}

/// The samples of a mask that lie in front of what is opaque: an opaque facet also where the other one comes later, so
/// that the order of drawing shows nowhere.
SampleMask Tile::in_front(const Facet& facet, std::size_t pixel, float depth, SampleMask mask) const {
    const Compared compared =
        compare_depths(facet.depth, depth, right_.data(), down_.data(), depths_.data() + pixel * count_, count_);
    SampleMask seen = compared.before, equal = compared.equal;
    if (!facet.sheet->translucent)
        for (equal &= mask; equal; equal &= equal - 1) {
            const auto i = static_cast<std::size_t>(std::countr_zero(equal));
            const std::uint32_t owner = owners_[pixel * count_ + i];
            if (owner != 0 && facet.is_before(facets_[owner - 1])) seen |= SampleMask{1} << i;
        }
    return seen & mask;
}

void Tile::cover(std::uint32_t facet, std::size_t pixel, float depth, SampleMask mask) {
    const Facet& one = facets_[facet];
    const bool translucent = one.sheet->translucent;
    if (translucent && one.depth.lower >= ranges_[pixel].farthest) return;
    const bool all_in_front = translucent && one.depth.upper < ranges_[pixel].nearest;
    if (covered_[pixel] && !all_in_front) mask = in_front(one, pixel, depth, mask);
    if (mask == 0) return;
    if (translucent) {
        fragments_.push_back({facet, heads_[pixel], mask});
        heads_[pixel] = static_cast<std::uint32_t>(fragments_.size());
        return;
    }
    covered_[pixel] = 1;
    cover_samples(one.depth, depth, right_.data(), down_.data(), mask, facet + 1, depths_.data() + pixel * count_,
                  owners_.data() + pixel * count_, count_);
}

/// What is seen in a row of pixels, and its shades.
void Tile::shade_row(std::int32_t y) {
    parts_.clear();
    places_.clear();
    row_.clear();
    for (std::int32_t x = 0; x < frame_.width; ++x) {
        const std::size_t pixel = pixel_of(x, y);
        PixelParts& here = row_.emplace_back(PixelParts{parts_.size(), 0, 0});
        const std::uint32_t* const owners = owners_.data() + pixel * count_;
        for (SampleMask left = covered_[pixel] ? all_ : 0; left;) {
            const std::uint32_t owner = owners[std::countr_zero(left)];
            const SampleMask mask = samples_of(owner, owners, count_) & all_;
            left &= ~mask;
            if (owner != 0) add_part(owner - 1, x, y, mask);
        }
        here.translucent = parts_.size();
        for (std::uint32_t at = heads_[pixel]; at != 0; at = fragments_[at - 1].next)
            add_part(fragments_[at - 1].facet, x, y, fragments_[at - 1].mask);
        here.end = parts_.size();
    }
    shades_.resize(places_.size());
    shade(places_, scene_.screen.sight, shades_);
}

/// Shaded at the middle of the samples that are seen, which is inside the facet.
void Tile::add_part(std::uint32_t facet, std::int32_t x, std::int32_t y, SampleMask mask) {
    const double half = 0.5 * scene_.screen.samples;
    double right = 0, down = 0;
    if (mask != all_) {
        float sum_right = 0, sum_down = 0;
        for (SampleMask left = mask; left; left &= left - 1) {
            const auto i = static_cast<std::size_t>(std::countr_zero(left));
            sum_right += right_[i];
            sum_down += down_[i];
        }
        const auto samples = static_cast<float>(std::popcount(mask));
        right = sum_right / samples;
        down = sum_down / samples;
    }
    parts_.push_back({facet, mask});
    places_.push_back({facets_[facet].sheet, facets_[facet].triangle,
                       static_cast<double>(frame_.x + x * frame_.samples) + half + right,
                       static_cast<double>(frame_.y + y * frame_.samples) + half + down});
}

/// Darker where little of the surroundings is seen.
Light Tile::opaque_color(const Facet& facet, const Light& shade, std::int32_t x, std::int32_t y) const {
    Light color = shade;
    if (!scene_.occlusion || !facet.sheet->lit) return color;
    const float depth = std::clamp(depth_in_middle(facet.depth, x, y), facet.depth.lower, facet.depth.upper);
    const float open = scene_.occlusion->openness(frame_.x / frame_.samples + x, frame_.y / frame_.samples + y, depth);
    for (float& part : color) part *= 1 - scene_.occlusion_strength * (1 - open);
    return color;
}

Tile::Blend Tile::resolve(std::int32_t x, std::int32_t y) {
    const PixelParts& here = row_[static_cast<std::size_t>(x)];
    if (here.first == here.end) return {};
    take_opaque(x, y);
    if (here.translucent == here.end) return mean_opaque_;
    take_layers(x, y);
    bool whole = true;
    for (std::size_t i = 0; i < layers_.size(); ++i) {
        whole = whole && layers_[i].mask == all_;
        if (i > 0) whole = whole && layers_[i - 1].depth + layers_[i - 1].reach < layers_[i].depth - layers_[i].reach;
    }
    if (whole) return blend_whole();
    return have_samples_of_their_own() ? blend_apart() : blend_samples();
}

/// The colours of samples without what is translucent, and their mean.
void Tile::take_opaque(std::int32_t x, std::int32_t y) {
    mean_opaque_ = {};
    std::ranges::fill(opaque_, Blend{});
    const PixelParts& here = row_[static_cast<std::size_t>(x)];
    for (std::size_t i = here.first; i < here.translucent; ++i) {
        const SampleMask mask = parts_[i].mask;
        const Blend color{opaque_color(facets_[parts_[i].facet], shades_[i].color, x, y), 1};
        for (SampleMask rest = mask; rest; rest &= rest - 1)
            opaque_[static_cast<std::size_t>(std::countr_zero(rest))] = color;
        const float part = static_cast<float>(std::popcount(mask)) / static_cast<float>(count_);
        for (std::size_t k = 0; k < 3; ++k) mean_opaque_.light[k] += part * color.light[k];
        mean_opaque_.opacity += part;
    }
}

/// The fragments of a pixel, by their depth in its middle.
void Tile::take_layers(std::int32_t x, std::int32_t y) {
    layers_.clear();
    const double middle = 0.5 * (scene_.screen.samples - 1);
    const PixelParts& here = row_[static_cast<std::size_t>(x)];
    for (std::size_t i = here.translucent; i < here.end; ++i) {
        const DepthPlane& plane = facets_[parts_[i].facet].depth;
        Layer layer;
        layer.depth = depth_in_middle(plane, x, y);
        layer.per_x = static_cast<float>(plane.per_x);
        layer.per_y = static_cast<float>(plane.per_y);
        layer.lower = plane.lower;
        layer.upper = plane.upper;
        layer.reach = (std::abs(layer.per_x) + std::abs(layer.per_y)) * static_cast<float>(middle);
        layer.mask = parts_[i].mask;
        layer.shade = shades_[i];
        layers_.push_back(layer);
    }
    // Where depths are equal the larger colour is in front, so that the order of drawing shows nowhere.
    const auto key = [](const Layer& layer) {
        const Light& color = layer.shade.color;
        return std::tuple(layer.depth, -color[1], -color[0], -layer.shade.opacity, -color[2], layer.mask);
    };
    std::ranges::sort(layers_, [&](const Layer& a, const Layer& b) { return key(a) < key(b); });
}

/// Where every layer covers the whole pixel, and one is before the other in all of it.
Tile::Blend Tile::blend_whole() const {
    Blend sum;
    for (const Layer& layer : layers_) {
        sum.add_behind(layer.shade.color, layer.shade.opacity);
        if (sum.opacity >= opaque_enough) break;
    }
    const float rest = 1 - sum.opacity;
    for (std::size_t i = 0; i < 3; ++i) sum.light[i] += rest * mean_opaque_.light[i];
    sum.opacity += rest * mean_opaque_.opacity;
    return sum;
}

/// Whether no sample has two of the layers.
bool Tile::have_samples_of_their_own() const {
    SampleMask taken = 0;
    for (const Layer& layer : layers_) {
        if (taken & layer.mask) return false;
        taken |= layer.mask;
    }
    return true;
}

/// Where no sample has two: blend_samples() without an order.
Tile::Blend Tile::blend_apart() const {
    std::array<const Shade*, 64> front{};
    for (const Layer& layer : layers_)
        for (SampleMask left = layer.mask; left; left &= left - 1)
            front[static_cast<std::size_t>(std::countr_zero(left))] = &layer.shade;
    Blend mean;
    for (std::uint32_t i = 0; i < count_; ++i) {
        Blend sum;
        if (front[i]) sum.add_behind(front[i]->color, front[i]->opacity);
        if (opaque_[i].opacity > 0) sum.add_behind(opaque_[i].light, 1);
        for (std::size_t k = 0; k < 3; ++k) mean.light[k] += sum.light[k];
        mean.opacity += sum.opacity;
    }
    mean.divide_by(count_);
    return mean;
}

Tile::Blend Tile::blend_samples() {
    Blend mean;
    for (std::uint32_t i = 0; i < count_; ++i) {
        order_.clear();
        for (const Layer& layer : layers_) {
            if (!(layer.mask >> i & 1)) continue;
            const float depth =
                std::clamp(layer.depth + layer.per_x * right_[i] + layer.per_y * down_[i], layer.lower, layer.upper);
            order_.emplace_back(depth, &layer);
            for (std::size_t k = order_.size() - 1; k > 0 && order_[k].first < order_[k - 1].first; --k)
                std::swap(order_[k], order_[k - 1]);
        }
        Blend sum;
        for (const auto& [depth, layer] : order_) {
            sum.add_behind(layer->shade.color, layer->shade.opacity);
            if (sum.opacity >= opaque_enough) break;
        }
        if (opaque_[i].opacity > 0) sum.add_behind(opaque_[i].light, 1);
        for (std::size_t k = 0; k < 3; ++k) mean.light[k] += sum.light[k];
        mean.opacity += sum.opacity;
    }
    mean.divide_by(count_);
    return mean;
}

} // namespace isotet::render
