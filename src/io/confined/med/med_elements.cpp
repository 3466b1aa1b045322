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

/// As in VTK.
constexpr std::array<std::uint8_t, 9> same_order{0, 1, 2, 3, 4, 5, 6, 7, 8};
constexpr MedElement flat_element(std::string_view name, std::uint32_t nodes, std::uint8_t vtk_type) {
    return {name, nodes, vtk_type, Order(same_order).first(nodes)};
}
constexpr std::array flat_elements{flat_element("PO1", 1, 1),  flat_element("SE2", 2, 3), flat_element("SE3", 3, 21),
                                   flat_element("SE4", 4, 35), flat_element("TR3", 3, 5), flat_element("TR6", 6, 22),
                                   flat_element("TR7", 7, 34), flat_element("QU4", 4, 9), flat_element("QU8", 8, 23),
                                   flat_element("QU9", 9, 28), flat_element("POG", 0, 7), flat_element("PO2", 0, 36),
                                   flat_element("PG2", 0, 36)};

const MedElement* found_in(std::span<const MedElement> elements, std::string_view name) {
    const auto found = std::ranges::find(elements, name, &MedElement::name);
    return found == elements.end() ? nullptr : &*found;
}

} // namespace

const MedElement* med_element(std::string_view name, MedCells cells) {
    return cells == MedCells::flat ? found_in(flat_elements, name) : found_in(med_solids, name);
}

std::uint32_t nodes_of_med_face(std::string_view name) {
    if (!name.starts_with("TR") && !name.starts_with("QU")) return 0;
    const MedElement* const face = found_in(flat_elements, name);
    return face ? face->nodes : 0;
}

} // namespace isotet::io::confined
