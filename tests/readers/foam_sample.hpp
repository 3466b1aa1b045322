// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// OpenFOAM cases made for tests: a box of cubes, some of them refined, so that their neighbours are polyhedra.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace isotet::test {

/// How the files are written.
struct FoamStyle {
    bool binary = false;
    int label = 32, scalar = 64; ///< bits
    bool addressing = true;      ///< pointProcAddressing and cellProcAddressing
};

/// A mesh of faces; corners wound out of the owner.
struct FoamBox {
    std::vector<std::array<double, 3>> points;
    std::vector<std::vector<std::int64_t>> faces;
    std::vector<std::int64_t> owner, neighbour; ///< of all faces; -1 on the boundary
    std::vector<std::array<double, 3>> centres; ///< of cells
    struct Patch {
        std::string name, type;
        std::size_t first, count;
    };
    std::vector<Patch> patches;
    struct Zone {
        std::string name;
        std::vector<std::int64_t> cells;
    };
    std::vector<Zone> zones;                               ///< none: no file of them
    std::vector<std::int64_t> point_numbers, cell_numbers; ///< in the whole, of a part

    std::array<double, 3> centre_of_face(std::size_t face) const;
};

/// `side` cubes of length 1 a direction; `refined` tells which become eight. Patches: "heated" (z = 0, wall), "sides".
FoamBox foam_box(int side, const std::function<bool(int x, int y, int z)>& refined);

/// The part of a processor, with processor patches, and the zones' own cells.
FoamBox part_of(const FoamBox& whole, const std::vector<int>& processor_of, int processor);

using FoamFunction = std::function<double(const std::array<double, 3>&)>;
using FoamFiles = std::map<std::string, std::string>; ///< names in the case

/// The files of constant/polyMesh.
void add_mesh(FoamFiles& files, const std::string& prefix, const FoamBox& box, const FoamStyle& style);

/// T, a scalar that is fixed on "heated" and has no gradient on "sides", and U, a vector (f, 2f, 3f), fixed too.
void add_fields(FoamFiles& files, const std::string& time_folder, const FoamBox& box, const FoamFunction& f,
                const FoamStyle& style);

/// The whole case, or one of `processors` parts, with the times 0 and 0.5.
FoamFiles foam_case(const FoamBox& box, const FoamFunction& f, const FoamStyle& style, int processors = 0);

/// The files of the folders processor0 and so on, as blocks of files in folders like "processors4"; with `groups`, in
/// one for each so many processors ("processors4_0-2", "processors4_3-3"). Blocks but the first have no header.
FoamFiles collated(const FoamFiles& files, const std::vector<int>& groups, bool grouped);

/// FoamFile { } with what follows.
std::string foam_file(const std::string& type, const std::string& name, const FoamStyle& style,
                      const std::string& body);

} // namespace isotet::test
