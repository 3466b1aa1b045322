// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "render_tets.hpp"

#include <algorithm>
#include <string_view>
#include <utility>

#include <fmt/format.h>

namespace isotet::cli {

namespace {

/// Device memory that pictures of this size need beside the store, with the numbers of all tets.
std::uint64_t picture_bytes(const PictureOptions& picture, std::uint64_t tets) {
    constexpr std::uint64_t max_samples = std::uint64_t{1} << 24, bytes_per_sample = 28, corners_of_quads = 2'000'000;
    const std::uint64_t samples = std::uint64_t{picture.width} * picture.height * picture.samples * picture.samples;
    return std::min(samples, max_samples) * bytes_per_sample + 4 * tets + corners_of_quads;
}

} // namespace

Result<void> check_method(const RenderCommand& command) {
    if (!command.method.draw) {
        if (command.index)
            return usage_error("--index finds the tets for a method that draws tets, but surfaces are drawn: --method");
        return {};
    }
    const std::string_view name = name_of(*command.method.draw);
    if (!command.color_by.empty())
        return usage_error(fmt::format("--color-by colours surfaces, but --method {} makes none", name));
    if (command.engine != EngineChoice::automatic)
        return usage_error(fmt::format("--engine says what extracts, but --method {} extracts nothing", name));
    return {};
}

Result<RenderTets> RenderTets::load(const RenderCommand& command, const PackedGrid& packed, const Device& device,
                                    Console& console) {
    const DrawMethod method = *command.method.draw;
    TetStoreOptions options;
    options.gradients = method == DrawMethod::textures || method == DrawMethod::mesh;
    options.picture_bytes = picture_bytes(command.picture, packed.report().tets);
    Result<TetStore> store =
        TetStore::upload(device, packed, method, options, console.run());
    if (!store) return store.error();
    RenderTets tets(*std::move(store));
    const SearchIndex index = command.index.value_or(default_index);
    if (index == SearchIndex::none) return tets;
    Result<TetIndex> built = TetIndex::create(packed, index, console.run());
    if (!built) return built.error();
    tets.index_ = *std::move(built);
    return tets;
}

Result<void> RenderTets::show(const std::vector<double>& isovalues) {
    surfaces_.clear();
    for (const double isovalue : isovalues) {
        Result<TetSurface> surface = Error{};
        if (index_) {
            const auto found = index_->find(isovalue);
            if (!found) return found.error();
            surface = store_.at(isovalue, *found);
        } else {
            surface = store_.at(isovalue);
        }
        if (!surface) return surface.error();
        surfaces_.push_back(*std::move(surface));
    }
    return {};
}

} // namespace isotet::cli
