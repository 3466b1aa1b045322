// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Planes, spheres and cylinders as they are written on a command line.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <isotet/isovalues.hpp>
#include <isotet/slice.hpp>

namespace isotet::cli {

/// Numbers separated by commas; none where one of them is no number.
std::vector<double> parse_numbers(std::string_view text);

/// "x=0.5", "-x=0.5" and "NX,NY,NZ,OFFSET".
std::optional<Plane> parse_plane(const std::string& text);

/// "x", "-x" (y and z alike) and "NX,NY,NZ".
std::optional<std::array<double, 3>> parse_direction(std::string_view text);

/// A shape, and all offsets or radii that were given, as numbers or as shares.
struct ShapeText {
    SliceShape shape;
    std::vector<double> at;
    std::vector<IsovalueShare> shares = {};
};

/// "90%v" and "p95"; nothing for other text.
std::optional<IsovalueShare> parse_share(std::string_view word);

/// As parse_plane(), "x=0.1,0.2", "x=50%v" and "DIRECTION@X,Y,Z".
std::optional<ShapeText> parse_planes(const std::string& text);

/// "X,Y,Z,R" and "X,Y,Z,R,R2"; each radius may be a share.
std::optional<ShapeText> parse_spheres(const std::string& text);

/// "DIRECTION@X,Y,Z,R" and "DIRECTION@X,Y,Z,R,R2".
std::optional<ShapeText> parse_cylinders(const std::string& text);

} // namespace isotet::cli
