// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The connected parts of a surface: counted, measured, kept or left out.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <isotet/array.hpp>
#include <isotet/export.hpp>
#include <isotet/progress.hpp>
#include <isotet/result.hpp>
#include <isotet/surface.hpp>

namespace isotet {

/// Triangles that hang together by their vertices.
struct SurfacePart {
    std::uint64_t triangles = 0, vertices = 0;
    double area = 0;
    double volume = 0;   ///< enclosed, positive where triangles face outwards; means something where it is closed
    bool closed = false; ///< every edge is used equally often in both directions
    std::array<double, 3> centre{}; ///< of its area
    std::array<double, 3> lower{}, upper{};
    std::vector<double> means; ///< of SurfaceParts::fields, weighted by area
};

/// `parts`     largest area first; of equal ones the one with the lowest vertex
/// `numbers`   uint32, F tuples: the part of each triangle, from 0
/// `fields`    names of the point and cell fields of the surface, a component each: "p", "velocity:0" and so on
struct SurfaceParts {
    std::vector<SurfacePart> parts;
    Array numbers;
    std::vector<std::string> fields;
};

/// Finds the parts of a surface and measures them.
///
/// Guarantees   the same for any thread count
/// Cost         O(F log F); 60 bytes a triangle while it works
/// Errors       invalid_data as check(), and from 2^32 parts on; out_of_memory; cancelled
ISOTET_API Result<SurfaceParts> find_parts(const Surface& surface, const Run& run = {});

/// The surface with some of its parts only, and the cell field "part" with their numbers.
///
/// `kept`     numbers of parts; all: only the field is added
/// Guarantees vertices and triangles keep their order; vertices that no triangle uses are gone
/// Errors     invalid_argument when a number is not below that of the parts, or the parts are of another surface
ISOTET_API Result<Surface> keep_parts(const Surface& surface, const SurfaceParts& parts,
                                      const std::vector<std::uint64_t>& kept, const Run& run = {});

/// A region by what its cells have: a value of a cell field in [lower, upper], of any component.
struct Region {
    std::string field; ///< a cell field that the surface carries; "boundary" of a solid is 1 on the grid's boundary
    double lower = 0, upper = 0;
};

/// Numbers of the parts that touch a region, ascending: those with a triangle in one of its cells.
///
/// Errors   invalid_argument when the surface has no such cell field, the range does not ascend, or the parts are of
///          another surface
ISOTET_API Result<std::vector<std::uint64_t>> parts_touching(const Surface& surface, const SurfaceParts& parts,
                                                             const Region& region);

/// Which connected parts of a surface are kept.
struct PartChoice {
    enum class Kind : std::uint8_t {
        largest,  ///< the `limit` ones of largest area
        area,     ///< those of a larger area than `limit`
        volume,   ///< closed ones that enclose more than `limit`
        touching, ///< those that touch `region` (parts_touching())
        numbers,  ///< those of `numbers`
        others    ///< all but those of `numbers`
    };
    Kind kind = Kind::largest;
    double limit = 1;
    std::string region = {}; ///< "boundary", the grid's, or what else a caller knows
    std::vector<std::uint64_t> numbers = {}; ///< as SurfaceParts counts; those that are not there do not matter

    friend bool operator==(const PartChoice&, const PartChoice&) = default;
};

/// "largest", "3", "area>0.5", "volume>2", "touching:boundary", "parts:0,2" or "not:1", and back. Nothing where it is none
/// of these.
ISOTET_API std::optional<PartChoice> parse_part_choice(std::string_view text);
ISOTET_API std::string to_text(const PartChoice& choice);

/// What parts are of: so it is known which of them touch the boundary of the grid.
enum class PartsOf : std::uint8_t {
    isosurface, ///< those that are not closed
    solid       ///< those with a triangle where the cell field "boundary" is 1
};

/// The numbers of the parts of a choice, ascending.
///
/// Errors   invalid_argument where a region other than "boundary" is to be touched, which parts_touching() finds; as that
ISOTET_API Result<std::vector<std::uint64_t>> chosen_parts(const Surface& surface, const SurfaceParts& parts,
                                                           const PartChoice& choice, PartsOf of);

/// Finds the parts of a surface, and keeps those of a choice. No field is added.
///
/// Errors   as find_parts(), chosen_parts() and keep_parts()
ISOTET_API Result<Surface> keep_parts(const Surface& surface, const PartChoice& choice, PartsOf of,
                                      const Run& run = {});

} // namespace isotet
