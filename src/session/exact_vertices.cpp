// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "session/exact_vertices.hpp"

#include "base/carry_out.hpp"
#include "linear/curved/exact_vertices.hpp"

namespace isotet::session {

Result<void> move_vertices(const LinearGrid* linear, const ContourInput& input, const ContourOptions& options,
                           std::span<const double> isovalues, std::vector<Extraction>& surfaces, const Run& run) {
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
        Surface& surface = surfaces[i].surface;
        if (linear && !linear->refined.nodes.empty()) {
            auto moved = core::carry_out("moving vertices", run, [&](const Progress& progress) {
                return linear::move_to_roots(*linear, input.field.values, input.point_fields, isovalues[i], surface,
                                             progress);
            });
            if (!moved) return moved;
        }
        if (options.normals == Normals::face || options.normals == Normals::vertex) {
            auto normals = options.normals == Normals::face ? face_normals(surface, run) : vertex_normals(surface, run);
            if (!normals) return normals.error();
            surface.normals = *std::move(normals);
            surface.normals_kind = options.normals;
        }
        if (!options.edge_ends) surface.edge_ends = surface.edge_weights = {};
        if (!options.source_cells) surface.source_cells = {};
    }
    return {};
}

} // namespace isotet::session
