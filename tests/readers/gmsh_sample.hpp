// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The cube of sample_bytes.hpp as MSH files of every kind.
#pragma once

#include <string>
#include <vector>

namespace isotet::test {

struct GmshVariant {
    bool version_4 = false;
    bool binary = false;
    bool swapped = false;    ///< binary in the other byte order
    bool sparse = false;     ///< node numbers far apart and not ascending
    bool parametric = false; ///< nodes carry parameters
};

/// "v41_binary_sparse" and so on.
std::string name_of(const GmshVariant& variant);
std::vector<GmshVariant> gmsh_variants();

/// Fields: point "temperature" at times 0 and 1.5 (10 n and 20 n for node n = 1..9), point "flow" (3 components) for
/// the first two nodes only, cell "porosity" (0.1 e for element e = 2..5, not for the triangle). Physical groups 7
/// (triangle) and 8; entities 3 (triangle, a surface) and 4 (a volume).
std::string gmsh_sample(const GmshVariant& variant);

} // namespace isotet::test
