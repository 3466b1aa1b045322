// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// A TSolid with all that the reader knows: two volumes that share a face through atoms, properties, no data, depth.
#pragma once

namespace isotet::test {

inline constexpr const char* gocad_sample = R"(GOCAD TSolid 1
HEADER {
name:two_volumes
*painted:true
}
GOCAD_ORIGINAL_COORDINATE_SYSTEM
NAME Default
AXIS_NAME "X" "Y" "Z"
AXIS_UNIT "m" "m" "m"
ZPOSITIVE Depth
END_ORIGINAL_COORDINATE_SYSTEM
PROPERTIES "rock type" velocity
PROP_LEGAL_RANGES **none**  **none** **none**  **none**
NO_DATA_VALUES -99999 -1
ESIZES 1 3
UNITS unitless m/s
PROPERTY_CLASS_HEADER velocity {
kind: Velocity
}
TETRA_PROPERTIES porosity
TETRA_NO_DATA_VALUES -99999
TETRA_ESIZES 1
TVOLUME lower
PVRTX 1 0 0 100.5 1 0 0 0
PVRTX 2 1 0 100 2 1 -1 1
VRTX 3 0 1 100
PVRTX 4 0 0 99 -99999 3 3 3
TETRA 1 2 3 4 0.25
# CTETRA lower none none none none
TVOLUME upper
PATOM 5 2 2 1 -1 1
PATOM 6 4 7 3 3 3
ATOM 7 3
PVRTX 8 1 1 99 4 4 4 4
ATOM 9 7
TETRA 5 9 6 8 -99999
TETRA 8 1 2 3 0.5
MODEL
SURFACE top
TFACE 1
TRGL 1 2 3
END
)";

} // namespace isotet::test
