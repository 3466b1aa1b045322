// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/confined/med/med_elements.hpp"

#include <algorithm>
#include <array>

namespace isotet::io::confined {
namespace {

/// MED goes around the base of a cell the other way than VTK: corners, and with them the middles of edges and faces,
/// are mirrored. Upright edges stand behind those of base and top in both.
constexpr std::array<std::uint8_t, 10> med_tetrahedron{0, 2, 1, 3, 6, 5, 4, 7, 9, 8};
constexpr std::array<std::uint8_t, 13> med_pyramid{0, 3, 2, 1, 4, 8, 7, 6, 5, 9, 12, 11, 10};
constexpr std::array<std::uint8_t, 6> med_linear_wedge{0, 2, 1, 3, 5, 4};
constexpr std::array<std::uint8_t, 18> med_wedge{0, 2, 1, 3, 5, 4, 8, 7, 6, 11, 10, 9, 12, 14, 13, 17, 16, 15};
constexpr std::array<std::uint8_t, 20> med_hexahedron{0,  3,  2, 1, 4,  7,  6,  5,  11, 10,
                                                      9,  8, 15, 14, 13, 12, 16, 19, 18, 17};
/// Faces in MED: base, then around from that of the first edge, top; in VTK: x, y, z, the lower one first.
constexpr std::array<std::uint8_t, 27> med_full_hexahedron{0,  3,  2,  1,  4,  7,  6,  5,  11, 10, 9,  8,  15, 14,
                                                           13, 12, 16, 19, 18, 17, 21, 23, 24, 22, 20, 25, 26};
constexpr std::array<std::uint8_t, 12> med_prism{0, 5, 4, 3, 2, 1, 6, 11, 10, 9, 8, 7};

using Order = std::span<const std::uint8_t>;
constexpr std::array med_solids{
    MedElement{"TE4", 4, 10, Order(med_tetrahedron).first(4)},
    MedElement{"T10", 10, 24, med_tetrahedron},
    MedElement{"PY5", 5, 14, Order(med_pyramid).first(5)},
    MedElement{"P13", 13, 27, med_pyramid},
    MedElement{"PE6", 6, 13, med_linear_wedge},
    MedElement{"P15", 15, 26, Order(med_wedge).first(15)},
    MedElement{"P18", 18, 32, med_wedge},
    MedElement{"HE8", 8, 12, Order(med_hexahedron).first(8)},
    MedElement{"H20", 20, 25, med_hexahedron},
    MedElement{"H27", 27, 29, med_full_hexahedron},
    MedElement{"O12", 12, 16, med_prism},
    MedElement{"POE", 0, med_polyhedron_type, {}},
};

} // namespace

const MedElement* med_element(std::string_view name) {
    const auto* const found = std::ranges::find(med_solids, name, &MedElement::name);
    return found == med_solids.end() ? nullptr : found;
}

std::uint32_t nodes_of_med_face(std::string_view name) {
    if (name.size() != 3 || !(name.starts_with("TR") || name.starts_with("QU"))) return 0;
    return is_flat_med_element(name) ? static_cast<std::uint32_t>(name.back() - '0') : 0;
}

bool is_flat_med_element(std::string_view name) {
    static constexpr std::array<std::string_view, 13> flat{"PO1", "SE2", "SE3", "SE4", "TR3", "TR6", "TR7",
                                                           "QU4", "QU8", "QU9", "POG", "PO2", "PG2"};
    return std::ranges::find(flat, name) != flat.end();
}

} // namespace isotet::io::confined
