// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <isotet/linear_cells.hpp>

namespace isotet {

std::vector<std::string> LinearizeReport::notes() const {
    std::vector<std::string> out;
    if (unmet > 0)
        out.push_back(fmt::format("{} of {} polyhedra matter to the isovalues: {} were split around a "
                                  "point inside (docs/cells.md)",
                                  polyhedra, polyhedra + unmet, centred));
    else if (centred > 0)
        out.push_back(fmt::format("{} of {} polyhedra were split around a point inside: with the others they are {} "
                                  "linear cells (docs/cells.md)",
                                  centred, polyhedra, cells));
    if (folded > 0)
        out.push_back(fmt::format(
            "{} polyhedra have no point that sees all their faces: the surface may be folded there", folded));
    if (open > 0)
        out.push_back(fmt::format("{} of {} polyhedra were left out: their faces do not close", open, polyhedra));
    if (high_degree > 0)
        out.push_back(
            fmt::format("{} cells of degree 3 and above or Bezier kinds were split into {} cells of degree 2 on "
                        "their own lattice: bounds are against these (docs/cells.md)",
                        high_degree, high_degree_parts));
    return out;
}

} // namespace isotet
