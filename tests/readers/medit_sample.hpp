// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The cube of sample_bytes.hpp as Medit files of every kind, and solutions for it.
#pragma once

#include <string>
#include <vector>

namespace isotet::test {

struct MeditVariant {
    int version = 0;      ///< 0: text; 1 to 4: binary
    bool swapped = false; ///< binary in the other byte order
};

/// "binary_3_swapped" and so on.
std::string name_of(const MeditVariant& variant);
std::vector<MeditVariant> medit_variants();

/// References: point n (from 0) has 10 + n, the cells 1 to 5. An unknown section stands between the known ones.
std::string medit_sample(const MeditVariant& variant);

/// Three fields: scalar n, vector (n, n + 0.25, n + 0.5), symmetric tensor (n, ..., n + 5), of point n.
std::string medit_solution_sample(const MeditVariant& variant);

/// Values 7 at vertices, and for cell c (1 to 4; not the triangle) the scalar c and the vector c, c + 0.25, c + 0.5.
std::string medit_cell_solution_sample(const MeditVariant& variant);

} // namespace isotet::test
