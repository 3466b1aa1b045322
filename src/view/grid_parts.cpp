// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The connected parts of a surface or solid, and isovalues by share.
#include <fmt/format.h>

#include "view/grid_view.hpp"

namespace isotet::view {

/// The isosurface as frames have it, with all its parts.
Result<Surface> GridView::whole_isosurface(const PartsMessage& message, double isovalue, const Run& run) {
    const bool packed = uses_packed() && lean_;
    if (packed) {
        const Result<PointField> field = field_of(message.state.field, run);
        if (!field) return field.error();
        return lean_->isosurface(*field, step_, isovalue, {}, run);
    }
    if (message.refined && refines()) {
        Result<ContourInput> input = input_of(message.state.field, {}, run);
        if (!input) return input.error();
        ContourOptions options;
        options.method = Method::direct;
        options.refine = options_.refine;
        Result<Contour> contour = Contour::create(*std::move(input), options);
        if (!contour) return contour.error();
        Result<ContourResult> made = contour->extract(isovalue, run);
        if (!made) return made.error();
        return std::move(made->surfaces.front().surface);
    }
    const Result<Source*> source = source_for(message.state, run);
    if (!source) return source.error();
    Result<ContourResult> made = (*source)->contour->extract(isovalue, run);
    if (!made) return made.error();
    return std::move(made->surfaces.front().surface);
}

Result<ShownParts> GridView::parts(const PartsMessage& message, const Run& run) {
    const ViewState& state = message.state;
    if (Result<void> there = show_grid(state.step, state.cells, run); !there) return there.error();
    const double isovalue = state.isovalues.front();
    Result<Surface> surface = Surface{};
    if (state.solid && !state.volume) {
        Result<Solid> solid = solid_at(state, isovalue, run);
        if (!solid) return solid.error();
        surface = std::move(solid->surface);
    } else surface = whole_isosurface(message, isovalue, run);
    if (!surface) return surface.error();
    Result<SurfaceParts> found = find_parts(*surface, run);
    if (!found) return found.error();
    const PartsOf of = state.solid && !state.volume ? PartsOf::solid : PartsOf::isosurface;
    const Result<std::vector<std::uint64_t>> kept =
        chosen_parts(*surface, *found, state.keep.value_or(PartChoice{PartChoice::Kind::others}), of);
    if (!kept) return kept.error();
    return ShownParts{std::move(found->parts), *kept};
}

Result<double> GridView::isovalue_at(const ShareMessage& message, const Run& run) {
    if (Result<void> there = show_grid(message.step, message.cells, run); !there) return there.error();
    const Result<PointField> field = field_of(message.field, run);
    if (!field) return field.error();
    if (message.share.of == IsovalueShare::Of::volume)
        if (Result<void> here = need_cells(run); !here) return here.error();
    const auto isovalues = isovalues_at(grid_, *field, {&message.share, 1}, run);
    if (!isovalues) return isovalues.error();
    return isovalues->front();
}

} // namespace isotet::view
