// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "small_grid.hpp"

#include <fmt/format.h>

namespace isotet::test {

std::string small_grid(const std::vector<SmallField>& fields) {
    std::string text = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
                       "$Nodes\n5\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 1 1 1\n$EndNodes\n"
                       "$Elements\n2\n1 4 2 1 1 1 2 3 4\n2 4 2 1 1 2 3 4 5\n$EndElements\n";
    int step = 0;
    for (const SmallField& field : fields) {
        const std::string section = field.on_cells ? "ElementData" : "NodeData";
        text += fmt::format("${}\n1\n\"{}\"\n1\n{}\n3\n{}\n1\n{}\n", section, field.name, field.time, step++,
                            field.values.size());
        for (std::size_t i = 0; i < field.values.size(); ++i) text += fmt::format("{} {}\n", i + 1, field.values[i]);
        text += fmt::format("$End{}\n", section);
    }
    return text;
}

} // namespace isotet::test
