// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "options/command_options.hpp"
#include "options/shape_text.hpp"

namespace isotet::cli {

namespace {

constexpr const char* slice_details = R"(
DIRECTION is x, y or z, with a minus for the other way, or three numbers NX,NY,NZ of any length. Where several offsets
or radii may stand, each may be a share: 50%v has half of the grid's volume before it (or inside), p10 a tenth of the
points.

A slice is the isosurface of a field that is computed at the points: what isotet extract says of OUT, steps, methods and
pieces holds. {value} in OUT, and the field isovalue, is the place: the product with the direction (z of z=0.5), or the
radius. Triangles face along the direction, or outwards. Without --with slices carry all point fields and, in .vtp, .vtk
and .ply, all cell fields.

Examples:
  isotet slice grid.vtu cut.vtp --plane z=0.5
  isotet slice grid.vtu cut.vtp --plane 1,1,0@0.5,0.5,0.5
  isotet slice grid.vtu halves.vtp --plane z=50%v
  isotet slice grid.vtu 'cut-{value}.vtp' --along z --count 20
  isotet slice run.pvd 'cut-{step}.vtp' --plane x=0.1,0.2,0.3 --all-steps
  isotet slice grid.vtu shell.vtp --cylinder z@0,0,0,0.4 --with pressure
  isotet slice grid.vtu half.stl --plane z=0.5 --solid below
)";

using ParseShape = std::optional<ShapeText> (*)(const std::string& text);

Option add_shape(const Command& command, SliceCommand& slice, const std::string& name, ParseShape parse,
                 const std::string& type, const char* rule, const std::string& description) {
    return command.add_value(
        name,
        [&slice, name, parse, rule](const std::string& text) {
            std::optional<ShapeText> parsed = parse(text);
            if (!parsed) refuse_value(name, text, rule);
            slice.shape = parsed->shape;
            slice.at = std::move(parsed->at);
            slice.shares = std::move(parsed->shares);
        },
        type, description);
}

void add_shapes(const Command& command, SliceCommand& slice) {
    const Option plane = add_shape(
        command, slice, "--plane", parse_planes, "PLANE",
        "x=0.5 or -x=0.5 (y and z alike, several numbers separated by commas), DIRECTION@X,Y,Z or NX,NY,NZ,OFFSET",
        "Cut along a plane: x=0.5, several x=0.1,0.2, DIRECTION@X,Y,Z through a point, or NX,NY,NZ,OFFSET where the "
        "product with the normal is the offset");
    const Option along = command.add_value(
        "--along",
        [&slice](const std::string& text) {
            const auto direction = parse_direction(text);
            if (!direction) refuse_value("--along", text, "x, y, z, with a minus too, or NX,NY,NZ");
            slice.shape = Plane{*direction, 0};
            slice.count = 1;
        },
        "DIRECTION",
        "Cut along planes across this direction, evenly inside the grid's extent; as many as --count says");
    command
        .add_count(
            "--count", {1, 1'000'000}, [&slice](std::uint64_t n) { slice.count = n; }, "N",
            "Number of planes, at min + k (max - min) / (N + 1), k = 1..N, of the extent of the cells; default: 1")
        .needs(along);
    const Option sphere =
        add_shape(command, slice, "--sphere", parse_spheres, "X,Y,Z,R[,R2...]", "X,Y,Z,R, centre and radius",
                  "Cut along a sphere: centre and radius; more radii cut along more spheres");
    const Option cylinder =
        add_shape(command, slice, "--cylinder", parse_cylinders, "DIRECTION@X,Y,Z,R[,R2...]",
                  "DIRECTION@X,Y,Z,R, such as z@0,0,0,0.5",
                  "Cut along a cylinder without ends: direction of its axis, a point on it, and the radius, or "
                  "several");
    along.excludes(plane);
    sphere.excludes(plane).excludes(along);
    cylinder.excludes(plane).excludes(along).excludes(sphere);
}

} // namespace

void add_slice_command(const Command& program, SliceCommand& slice) {
    const Command command =
        program.add_command("slice", "Cut a grid along planes, spheres or cylinders, with its fields");
    add_grid_and_surface(command, slice);
    add_shapes(command, slice);
    add_surface_options(command, slice,
                        "Closed solids: the part of the grid beyond the plane or outside the shape (above), before it "
                        "or inside (below), or, with --along, from A to B; cell field boundary: 1 at the grid's "
                        "boundary, 0 on the cut");
    add_common(command, slice.common);
    command.set_common({"--output", "--plane", "--along", "--count", "--all-steps", "--with"});
    command.set_details(slice_details);
}

} // namespace isotet::cli
