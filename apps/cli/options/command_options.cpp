// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "options/command_options.hpp"
#include "options/shape_text.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <memory>

#include <fmt/format.h>

#include <isotet/jobs/number_text.hpp>
#include <isotet/text.hpp>

namespace isotet::cli {

namespace {

/// An option whose value is a number of bytes, more than 0.
void add_bytes(const Command& command, const char* name, std::optional<std::uint64_t>& bytes, const char* help) {
    command.add_value(
        name,
        [name, &bytes](const std::string& text) {
            bytes = parse_bytes(text);
            if (!bytes || *bytes == 0) refuse_value(name, text, "bytes, such as 2GB");
        },
        "BYTES", help);
}

void add_memory(const Command& command, std::optional<std::uint64_t>& memory) {
    const OptionGroup group(command, "Method and machine");
    add_bytes(command, "--memory", memory,
              "Of a packed file, keep at most so much in memory, such as 2GB; default: half of what is free");
}

/// `what`   is made between two steps
void add_interpolate(const Command& command, std::uint64_t& between, const std::string& what) {
    constexpr std::uint64_t most = 10'000;
    command
        .add_count(
            "--interpolate", {1, most}, [&](std::uint64_t n) { between = n; }, "N",
            "N more " + what +
                " between two steps of a packed file, of values (1-w)a+wb; points likewise where they move. {step} in "
                "OUT then counts all of them")
        .needs(command.option("--all-steps"));
}

constexpr const char* program_details = R"(
isotet FILE is short for isotet info FILE. FILE may be make:SHAPE:SIDE[:FIELDS] wherever a grid is read: a test grid
made in memory, make:kuhn:64:gyroid for example.

Tables go to standard output, notes and errors to standard error. Ctrl-C stops within 0.3 s and leaves no half
written file; a second Ctrl-C ends the program at once.

Exit status:
  0    done
  1    a check failed
  2    usage: an option or a name is wrong
  3    a file, or the data in it
  4    the machine: memory, disk, device, standard output
  5    a bug of isotet: please report it
  130  interrupted
)";

constexpr const char* info_details = R"(
A field's range is that of its finite values; no data is the number of NaN. Inverted tets are those whose sign is not
that of most. --survey counts repeated tets (with the corners of an earlier one), duplicate points (at the place of
another) and boundary faces (which the tets do not use equally often in both directions).

Several files are time steps where their names differ in numbers alone; others are told one by one.

Shown first is what isotet render, view and extract take where no field is named: the array that the file marks as its
scalars; else one with a name that people contour, such as temperature, velocity or pressure; else the one that varies
most. Where isosurfaces would say little, the boundary is drawn, coloured by it or by regions.

--chart gives areas in the square, and volumes in the cube, of the unit of the points: those of the tets that extract
--split-cells makes; quadratic cells are split at their nodes.

Examples:
  isotet info grid.vtu
  isotet info grid.vtu --chart 20 -f pressure
  isotet info grid.vtu --chart 1000 -f pressure --json -
)";

constexpr const char* extract_details = R"(
FIELD is taken whole first; only if no field has that name is the part after the last colon a component: x, y, z, mag,
or a number from 0. Velocity stands for the fields VelocityX, VelocityY and VelocityZ, disp for disp_x, disp_y and
disp_z, and x, y and z for the coordinates, where no field is called so. A cell field is averaged to the points,
weighted by volume (ParaView's Cell Data to Point Data takes the plain mean).

OUT ends in .vtp, .ply, .stl, .3mf, .obj, .glb, .usda, .vtk or .ts; without OUT only the numbers are printed. Several
isovalues in one OUT make one surface with a cell field isovalue; without one the middle of the range is taken. With
{value}, {time} or {step} in OUT there is one file each; steps are numbers of equal length, from 0. Beside the .vtp
files of several time steps a collection is written, front.pvd for front-{step}.vtp, which ParaView opens as one
series (one that isotet has not written is kept); beside .usda files front.usda. A .glb without {step} has all time
steps. Ctrl-C leaves the files that were complete.

{name} in OUT makes several files grids of their own in place of time steps: it is the name of each without folder and
ending. What fails is said, the others go on, and the exit status is the worst.

A point whose value equals the isovalue counts as above it. Triangles face the side of higher values. The methods give
the same vertices and triangles in a different order, but direct repeats the triangles of repeated cells, which clusters
drops. auto takes clusters from 32 surfaces on (isovalues times time steps), from 4 with gradient normals, or with a
device; else direct, also where packing finds too little memory (noted).

Triangles of solids (--solid) face outwards, those of the isosurface first; the report tells the volume of the solid
and of the grid. --solid A:B takes no other isovalues.

Pieces (--piece) have equally many cells, in the order of the file. Edge ends and source cells have the numbers of the
whole grid. Normals of vertices at the rim of a piece are those of its own cells, and do not fit those of the next.

Examples:
  isotet extract grid.vtu surface.vtp -f pressure -i 0.5
  isotet extract grid.e 'shell-{value}.stl' -f temp -i 300,350,400
  isotet extract run.pvd 'front-{step}.vtp' -f c -i 0.5 --all-steps
  isotet extract *.vtu -f c -i 0.5 -o 'surfaces/{name}.vtp'
  isotet extract grid.vtu surface.vtp -f pressure -i @isovalues.txt --with pressure,velocity
  isotet extract make:kuhn:64:gyroid -i 0
  isotet extract grid.vtu part.stl -f density -i 0.5 --solid above
  isotet extract grid.vtu surface.vtp -f pressure -i 0.5 --engine vulkan
  isotet extract grid.vtu part-2.vtp -f pressure -i 0.5 --piece 2/8
)";

constexpr const char* check_details = R"(
Fails (exit status 1) if the surface has: an edge that is used unequally often in the two directions where it must
not be; a triangle with two equal corners; a triangle that occurs twice in the same direction.

Where edges must be used equally often: with --closed everywhere; with --grid everywhere except on edges whose grid
points all lie in one boundary face of the tets that have a value at each point; with neither they are only counted.
--grid needs the point array edge_ends, which isotet extract --edge-ends writes into .vtp and .vtk, and excuses a
repeated triangle on a face with two tets on one side.

Where quadratic cells were refined for the surface, their points are derived again, as the file's field data
isotet:refinement say, or -i (all isovalues of that isotet extract) and the tolerances. Of several time steps that of
the field data isotet:time counts, else the one that isotet extract takes. Give the same --hanging-points as then: edges
at hanging points fail, where the face of a larger cell meets smaller ones (of curved cells, which are not closed there,
all open edges). With --hanging-points leave they are excused.

With --strict it also fails for: triangles of zero area, edges with more than two triangles, double sheets (two
triangles on the same corners in opposite directions), touching vertices (triangles that are not one fan), coincident
vertices.

The vertices of STL, and of several files (the pieces of isotet extract --piece), are merged first: those on one edge
of the grid (edge_ends), else those of equal coordinates. Triangles that collapse by that are counted, and no defect.
)";

constexpr const char* pack_details = R"(
A packed file holds the grid as isotet works on it, in half the size of its arrays. Every command reads it as a grid;
extract reads only what its isovalues meet.

Examples:
  isotet pack grid.vtu grid.isotet
  isotet extract grid.isotet -f pressure -i 0.5 -o front.vtp
  isotet pack run.pvd run.isotet --all-steps --fields p,T
  isotet pack huge.vtu huge.isotet --memory 8GB --scratch /data
  isotet check grid.isotet
)";

constexpr const char* make_details = R"(
Shapes, on the cube from -1 to 1: kuhn (six tets a cube), perturbed (inner points moved), shuffled (perturbed, points
and tets in random order), layer (cells of aspect ratio up to 1000), hex, wedge, pyramid, mixed (all four cell types), tet10
(quadratic tets), curved (bent ones), hex27 (triquadratic hexahedra), kelvin (polyhedra of 14 faces, two a cube). With hanging
points: octree (hexahedra, smaller ones near the sphere), octree-random (any cut into eight, edges up to four times
as long as their neighbours'), octree-bent (the same, warped), octree-tets (the same, six tets a cube).
The same bytes for any number of threads.

Fields: sphere, torus, plane, gyroid, wavelet, integer (many ties).

Examples:
  isotet make kuhn --side 64 -o kuhn.vtu
  isotet make mixed --side 20 --fields sphere,integer -o mixed.vtk
)";

constexpr const char* formats_details = R"(--format takes the names in the first column.
)";

constexpr const char* devices_details = R"(
A device can be used when it has Vulkan 1.1 and what the engine needs; else the reason is told. Software devices are
used only with --device software. Without Vulkan, or without a device, isotet works on the CPU.

With --device that device is opened, and its arithmetic is compared with the processor's, bit by bit, in a few thousand
cases that are hard to round. Where they differ, surfaces may differ from the CPU's in their last bits, and every
command that uses the device says so.
)";

constexpr const char* view_details = R"(
Prints one address, and opens it in the browser if there is one on this machine. Whoever has the address can look,
from this machine only; from another one through ssh, by a line that is printed where isotet was started over ssh.
Ctrl-C ends it. Press ? in the page for its keys.

Examples:
  isotet view grid.vtu
  isotet view grid.vtu -f pressure -i 0.5 --color-by temperature
  isotet view coarse.vtu --beside fine.vtu
  isotet view make:kuhn:64:sphere,gyroid
  isotet view grid.vtu --no-browser --port 8123
)";

constexpr const char* export_details = R"(
OUT is a page that shows isosurfaces with a slider, as isotet view does, and loads nothing. It holds the packed grid,
with the fields of -f and --color-by, or without -f all point fields; where it would be larger than --max-size, those
fields that do not fit are left out, and then values are rounded to 16 bits. Or it holds N surfaces between two
isovalues, or those of -i, at one time step or all; of the N surfaces every second, third and so on, where all would be
too large. Notes tell what was done.

Examples:
  isotet export grid.vtu grid.html -f pressure
  isotet export grid.vtu grid.html -f pressure --surfaces 200 --between 0.2,0.6 --color-by temperature
  isotet export run.pvd run.html -f pressure -i 0.5 --all-steps --max-size 50MB
)";

constexpr const char* page_details = R"(
OUT is the page of isotet view with isotet in it as WebAssembly, and no grid: files are dropped into it, or chosen, and
read in the browser. Nothing of them leaves the machine. Open it from a disk, or put it on any web server.

Examples:
  isotet page isotet.html
)";

/// Which device, which grid, and what every command has.
void add_machine_and_input(const Command& command, DeviceChoice& device, GridOptions& grid, CommonOptions& common) {
    add_device(command, device);
    add_device_memory(command, device);
    add_time(command, grid);
    add_reading(command, grid, "--format");
    add_common(command, common);
}

void add_info(const Command& program, InfoCommand& info) {
    const Command command = program.add_command("info", "Show what is in a grid file");
    command.add_file("FILE", info.grid.file, "FILE", "A grid: a file, or make:SHAPE:SIDE[:FIELDS]").required();
    add_more_files(command, info.grid);
    add_time(command, info.grid);
    add_reading(command, info.grid, "--format");
    const Option survey = command.add_flag(
        "--survey", info.survey,
        "Count repeated tets, duplicate points, boundary faces and hanging points, too: that takes about as long as "
        "reading");
    const Option chart = command.add_count(
        "--chart", {1, 65'535}, [&](std::uint64_t n) { info.chart = n; }, "N",
        "Area of the isosurface and volume below it at N + 1 isovalues, from end to end of the field's range");
    const Option all_steps =
        command.add_flag("--all-steps", info.all_steps, "Ranges of fields over all time steps, each of which is read");
    for (const char* name : {"--time", "--step"}) all_steps.excludes(command.option(name));
    const Option each_block = command.add_flag("--each-block", info.each_block,
                                               "Also cell types and ranges of each block, which is read by itself");
    command
        .add_flag("--heads", info.heads,
                  "Only what the file announces, without reading values: fields, cells, time steps, blocks")
        .excludes(survey)
        .excludes(chart)
        .excludes(each_block)
        .excludes(all_steps);
    add_field(command, info.field, "The field of the chart; default: the one that is shown first").needs(chart);
    add_common(command, info.common);
    command.set_common({"--heads", "--survey", "--chart", "--all-steps", "--time", "--json"});
    command.set_details(info_details);
}

void add_levels(const Command& command, ExtractCommand& extract) {
    const Option isovalues = add_isovalues(command, extract.isovalues, extract.shares, &extract.decimal_comma);
    command
        .add_count(
            "--levels", {1, 1'000'000}, [&](std::uint64_t n) { extract.levels = n; }, "N",
            "N isovalues evenly inside the range of the field at each time step: min + k (max - min) / (N + 1), k = "
            "1..N")
        .excludes(isovalues);
    command.add_flag("--snap", extract.snap, "Round isovalues to the field's type: 0.7 becomes 0.699999988 on float32");
}

void add_surface_arrays(const Command& command, ExtractJob& extract) {
    const OptionGroup group(command, "Arrays of the surface");
    command.add_choice<Normals>("--normals", extract.contour.normals,
                                {{"none", Normals::none},
                                 {"gradient", Normals::gradient},
                                 {"face", Normals::face},
                                 {"vertex", Normals::vertex}},
                                "Normals: at each vertex the gradient of the field, from all cells; of each face; or "
                                "at each vertex the mean of its triangles'");
    command.add_texts(
        "--with", [&](const std::vector<std::string>& names) { extract.with = names; }, "FIELD[,...]",
        "Carry these point and cell fields onto the surface; may be repeated; an empty name carries none. Default: "
        "point fields that the format can hold");
    command.add_flag(
        "--edge-ends", extract.contour.edge_ends,
        "Write the two grid points of each vertex (edge_ends) and its place between them (edge_weights); .vtp, .vtk");
    command.add_flag("--source-cells", extract.contour.source_cells,
                     "Write the grid cell of each triangle (source_cell); .vtp, .vtk");
    command.add_flag("--exact-vertices", extract.contour.exact_vertices,
                     "Quadratic cells: vertices where the quadratic field has the isovalue on their edges");
    command.add_flag("--split-cells", extract.contour.split_cells,
                     "Split pyramids, wedges and hexahedra into tets first: 2 to 3 times the triangles");
}

/// "2/8": the second of eight.
PieceOf parse_piece(const std::string& text) {
    PieceOf out;
    const char* const end = text.data() + text.size();
    const auto [slash, first] = std::from_chars(text.data(), end, out.piece);
    const bool divided = first == std::errc{} && slash != end && *slash == '/';
    const auto [rest, second] = divided ? std::from_chars(slash + 1, end, out.pieces) : std::from_chars_result{end, {}};
    if (!divided || second != std::errc{} || rest != end || out.piece < 1 || out.piece > out.pieces)
        refuse_value("--piece", text, "K/N, K from 1 to N");
    --out.piece;
    return out;
}

/// "above", "below", "0.1:0.5".
SolidChoice parse_solid(const std::string& text) {
    if (text == "above") return {SolidChoice::Kind::above, {}};
    if (text == "below") return {SolidChoice::Kind::below, {}};
    SolidChoice out{SolidChoice::Kind::between, {}};
    if (text.find(':') == std::string::npos)
        refuse_value("--solid", text, "above, below, or two isovalues A:B, A below B");
    out.range = parse_range("--solid", text, out.shares);
    return out;
}

/// "90%" or "0.9".
double parse_reduction(const std::string& text) {
    double share = 0;
    const char* const end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data(), end, share);
    const bool percent = error == std::errc{} && rest + 1 == end && *rest == '%';
    if (percent) share /= 100;
    if (error != std::errc{} || (!percent && rest != end) || !(share >= 0 && share < 1))
        refuse_value("--reduce", text, "a share of the triangles from 0 to below 1, such as 90% or 0.9");
    return share;
}

ReduceOptions& wanted_reduction(ExtractJob& job) {
    if (!job.reduce) job.reduce = ReduceOptions{0.99};
    return *job.reduce;
}

void add_extract(const Command& program, ExtractCommand& extract) {
    const Command command = program.add_command("extract", "Extract isosurfaces and write them into files");
    add_grid_and_surface(command, extract);
    add_field(command, extract.field,
              "The field to contour, or an expression such as mag(U); default: the one that info says is shown first");
    add_centre(command, extract.field);
    add_levels(command, extract);
    add_surface_options(command, extract,
                        "Closed solids: the part of the grid where the field is at least the isovalue, below it, or "
                        "from A to B; cell field boundary: 1 on the grid's boundary, 0 on isosurfaces");
    add_common(command, extract.common);
    command.set_common({"--output", "--field", "--isovalue", "--all-steps", "--with", "--solid"});
    command.set_details(extract_details);
}

void add_render(const Command& program, RenderCommand& render) {
    const Command command = add_render_command(program, render);
    add_memory(command, render.memory);
    add_machine_and_input(command, render.device, render.grid, render.common);
    const Option all_steps = command.add_flag("--all-steps", render.all_steps,
                                              "A picture of every time step, with one camera and one colour scale");
    for (const char* name : {"--time", "--step", "--sweep", "--orbit", "--reference"})
        all_steps.excludes(command.option(name));
    add_interpolate(command, render.interpolate, "pictures");
    command.set_common({"--output", "--field", "--isovalue", "--color-by", "--view", "--all-steps"});
}

void add_view(const Command& program, ViewCommand& view) {
    const Command command = program.add_command("view", "Look at isosurfaces in the browser, with a slider");
    command.add_file("FILE", view.grid.file, "FILE", "A grid: a file, or make:SHAPE:SIDE[:FIELDS]").required();
    add_more_files(command, view.grid);
    add_field(
        command, view.field,
        "The field to begin with, or an expression such as mag(U); default: the one that info says is shown first");
    add_isovalues(command, view.isovalues, view.shares, &view.decimal_comma);
    command.add_text("--color-by", view.color_by, "FIELD", "Colour by this point or cell field to begin with");
    command.add_file("--beside", view.beside, "FILE",
                     "Show this file beside it, read by the same options, with linked cameras and isovalues");
    command.add_count(
        "--port", {1, 65535}, [&](std::uint64_t n) { view.port = n; }, "N",
        "The port of 127.0.0.1 to serve the page at; default: that of the last run with this file, or a free one");
    command.add_texts(
        "--allow-host",
        [&](const std::vector<std::string>& names) { view.hosts.insert(view.hosts.end(), names.begin(), names.end()); },
        "NAME", "A name by which browsers reach the page, of a proxy say, beside localhost; may be repeated");
    command.add_file(
        "--out", view.out, "FOLDER",
        "A folder into which the page may save pictures, surfaces and animations, by name; without it, it downloads "
        "them");
    command.add_text("--listen", view.listen, "ADDRESS",
                     "Serve at this address of the machine (0.0.0.0: all) instead of 127.0.0.1: whoever knows the "
                     "printed address can look, over an open line; or unix:PATH, a socket that only you can open");
    command.add_count(
        "--pages", {1, 30}, [&](std::uint64_t n) { view.pages = n; }, "N",
        "Pages that may be open at once, of which two beside each other are two; default: 4");
    command.add_flag(
        "--keep", view.keep,
        "Keep running after the last page was closed; default: end after a minute, or half an hour after it "
        "was lost");
    command.add_flag("--no-browser", view.no_browser, "Open no browser: only print the address");
    add_refinement(command, view.refine);
    add_memory(command, view.memory);
    add_time(command, view.grid);
    add_reading(command, view.grid, "--format");
    add_common(command, view.common);
    command.set_common({"--field", "--isovalue", "--color-by", "--beside", "--no-browser", "--port", "--out"});
    command.set_details(view_details);
}

Option add_range_of_surfaces(const Command& command, ExportCommand& exported) {
    return command.add_numbers("--between", exported.range, "A,B",
                               "The range of --surfaces: numbers, or shares such as 5%v or p95 (of the first step); "
                               "default: that of the field",
                               {[&exported](std::string_view word) {
                                    const std::optional<IsovalueShare> share = parse_share(word);
                                    if (!share || exported.range.size() > 1) return false;
                                    (exported.range.empty() ? exported.range_shares.lower
                                                            : exported.range_shares.upper) = share;
                                    exported.range.push_back(0); // until the grid is read
                                    return true;
                                },
                                "two finite numbers or shares such as 90%v or p95"});
}

void add_export(const Command& program, ExportCommand& exported) {
    const Command command = program.add_command("export", "Make a page of one file with isosurfaces and a slider");
    command.add_file("FILE", exported.grid.file, "FILE", "A grid: a file, or make:SHAPE:SIDE[:FIELDS]").required();
    command.add_file("OUT", exported.out, "OUT_FILE", "The page: .html").required();
    add_field(command, exported.field,
              "The field to contour, or an expression such as mag(U); default: the one that info says is shown first");
    const Option isovalues = add_isovalues(command, exported.isovalues, exported.shares);
    command.add_choice<PageContent>(
        "--as", exported.content, {{"surfaces", PageContent::surfaces}, {"grid", PageContent::grid}},
        "What is in the page: isosurfaces, or the grid, with isotet as WebAssembly: any isovalue, slices, colours by "
        "all "
        "its fields; default: the grid where it fits, but surfaces with -i, --surfaces and --between");
    command
        .add_count(
            "--surfaces", {1, 10'000}, [&](std::uint64_t n) { exported.count = n; }, "N",
            "N isosurfaces evenly inside the range, at short decimals; default: 63")
        .excludes(isovalues);
    add_range_of_surfaces(command, exported).excludes(isovalues);
    command.add_text("--color-by", exported.color_by, "FIELD", "Colour by this point or cell field");
    add_bytes(command, "--max-size", exported.max_size, "Largest size of the file; default: 20MB");
    add_refinement(command, exported.refine);
    add_time(command, exported.grid);
    command.add_flag("--all-steps", exported.all_steps, "All time steps")
        .excludes(command.option("--time"))
        .excludes(command.option("--step"));
    add_reading(command, exported.grid, "--format");
    add_common(command, exported.common);
    command.set_common({"--field", "--isovalue", "--as", "--color-by", "--all-steps", "--max-size"});
    command.set_details(export_details);
}

void add_bench(const Command& program, BenchCommand& bench) {
    const Command command = add_bench_command(program, bench);
    add_machine_and_input(command, bench.device, bench.grid, bench.common);
    for (const char* name : {"--time", "--step", "--format", "--block", "--displace", "--merge-points", "--keep-pieces",
                             "--allow-outside", "--cell-field"})
        command.option(name).excludes(command.option("--paper"));
}

void add_check(const Command& program, CheckCommand& check) {
    const Command command = program.add_command("check", "Measure a surface and check it for defects");
    command
        .add_texts(
            "SURFACE",
            [&](const std::vector<std::string>& names) {
                for (const std::string& name : names)
                    if (name.empty()) refuse_value("SURFACE", name, "the name of a file");
                check.surface = names.front();
                check.more.assign(names.begin() + 1, names.end());
            },
            "SURFACE_FILE", "A surface: .vtp, .ply, .stl, .obj, .vtk or .ts; or its pieces, one after another")
        .required();
    command.add_flag("--closed", check.closed, "Report every edge that is used unequally often in the two directions");
    const Option grid = command.add_file("--grid", check.grid.file, "FILE",
                                         "Report such edges unless they lie in one boundary face of this grid");
    add_field(command, check.field, "The field that was contoured: cells without a value do not count").needs(grid);
    command.option("--cell-field").needs(grid);
    add_time(command, check.grid);
    command.add_flag("--split-cells", check.contour.split_cells, "The surface was made with --split-cells").needs(grid);
    add_isovalues(command, check.isovalues, check.shares).needs(grid);
    add_refinement(command, check.contour.refine, &check.refine_averaged);
    for (const char* name : {"--tolerance", "--distance", "--geometry-tolerance"}) command.option(name).needs(grid);
    command.add_flag("--strict", check.strict,
                     "Fail also for flat triangles, touching vertices and the like (--help-all)");
    command.add_text("--format", check.format, "FORMAT", "Format of the surface; default: the name decides");
    add_reading(command, check.grid, "--grid-format");
    for (const char* name :
         {"--time", "--step", "--grid-format", "--displace", "--merge-points", "--hanging-points", "--keep-pieces"}) {
        command.option(name).needs(grid);
    }
    add_common(command, check.common);
    command.set_common({"--closed", "--grid", "--field", "--isovalue", "--strict", "--json"});
    command.set_details(check_details);
}

void add_pack(const Command& program, PackCommand& pack) {
    const Command command = program.add_command("pack", "Pack a grid into a file that opens at once");
    command.add_file("FILE", pack.grid.file, "FILE", "A grid: a file, or make:SHAPE:SIDE[:FIELDS]").required();
    command.add_file("OUT", pack.out, "OUT_FILE", "The packed file: .isotet").required();
    command.add_texts(
        "--fields", [&](const std::vector<std::string>& names) { pack.fields = names; }, "FIELD[,...]",
        "The fields to pack, separated by commas; may be repeated. Default: all point fields of one or three "
        "components, or else the field that info says is shown first");
    command.add_texts(
        "--cell-fields", [&](const std::vector<std::string>& names) { pack.cell_fields = names; }, "FIELD[,...]",
        "Pack these cell fields as they are, and source cells, for --with and --color-by");
    command.add_flag("--cell-field", pack.cell_field,
                     "A name that is both a point and a cell field means the cell field");
    add_time(command, pack.grid);
    command.add_flag("--all-steps", pack.all_steps, "All time steps; they must have the same cells")
        .excludes(command.option("--time"))
        .excludes(command.option("--step"));
    command.add_flag(
        "--append", pack.append,
        "Add the time step, or all, to OUT, which has the same cells: with its fields, precision and so on");
    command.add_flag("--source-cells", pack.pack.source_cells,
                     "Keep the numbers of cells, for extract --source-cells: 4 bytes a tet, 8 another cell");
    command.add_flag("--gradients", pack.pack.gradients,
                     "Keep gradients, for --normals gradient: 4 bytes a point, a field and a step");
    command.add_flag("--split-cells", pack.pack.split_cells, "Split pyramids, wedges and hexahedra into tets first");
    command.add_choice<Precision>("--precision", pack.pack.precision,
                                  {{"float", Precision::float32}, {"double", Precision::float64}},
                                  "Precision of the packed grid");
    add_bytes(command, "--memory", pack.memory,
              "Aim for less memory than this, such as 2GB: what needs more lies in files meanwhile; default: half of "
              "what is free with --scratch, else no limit");
    command.add_file("--scratch", pack.scratch, "FOLDER", "The folder of these files; default: that of OUT");
    add_reading(command, pack.grid, "--format");
    add_common(command, pack.common);
    command.set_common({"--fields", "--all-steps", "--append", "--time", "--step", "--split-cells"});
    command.set_details(pack_details);
}

void add_make(const Command& program, MakeCommand& make) {
    const Command command = program.add_command("make", "Make a test grid with analytic fields");
    command
        .add_text("SHAPE", make.grid.shape, "SHAPE",
                  "kuhn, perturbed, shuffled, layer, hex, wedge, pyramid, mixed, tet10, curved, hex27, kelvin, octree, "
                  "octree-random, octree-bent or octree-tets")
        .required();
    command
        .add_count(
            "--side", {1}, [&](std::uint64_t n) { make.grid.side = n; }, "N", "Cubes along an edge, 1 to 4096")
        .required();
    command.add_words(
        "--fields", [&](const std::vector<std::string>& names) { make.grid.fields = names; }, "A[,B...]",
        "Fields, separated by commas; default: sphere,gyroid");
    command.add_count(
        "--seed", {}, [&](std::uint64_t n) { make.grid.seed = n; }, "N", "Seed of what is random; default: 1");
    command.add_file("-o,--output", make.out, "OUT_FILE", "The grid: .vtu or .vtk").required();
    add_compression(command, make.compression, ".vtu");
    add_common(command, make.common);
    command.set_details(make_details);
}

void add_page(const Command& program, PageCommand& page) {
    const Command command = program.add_command("page", "Make a page of one file into which grids are dropped");
    command.add_file("OUT", page.out, "OUT_FILE", "The page: .html").required();
    add_common(command, page.common);
    command.set_details(page_details);
}

void add_formats(const Command& program, FormatsCommand& formats) {
    const Command command = program.add_command("formats", "List the file formats");
    add_common(command, formats.common);
    command.set_details(formats_details);
}

void add_devices(const Command& program, DevicesCommand& devices) {
    const Command command = program.add_command("devices", "List the graphics cards and other Vulkan devices");
    add_device(command, devices.device);
    add_common(command, devices.common);
    command.set_details(devices_details);
}

void add_help(const Command& program, HelpCommand& help) {
    const Command command = program.add_command("help", "Show the help of a command, or this list");
    command.add_text("COMMAND", help.topic, "COMMAND", "A command, such as extract");
}

void add_docs(const Command& program, DocsCommand& docs) {
    const Command command = program.add_command(
        "docs", "Print the man page, the completion of a shell, docs/command-line.md or the page of Python's html()");
    command.add_text("KIND", docs.kind, "man|bash|fish|zsh|markdown|page", "").required();
    command.add_text("COMMAND", docs.topic, "COMMAND", "Of man: the page of this command");
    command.hide(); // for the build, not for users
}

} // namespace

PartChoice parse_parts(const std::string& text) {
    std::optional<PartChoice> choice = parse_part_choice(text);
    if (!choice)
        refuse_value("--keep", text,
                     "largest, a number of parts from 1, area>A, volume>V, touching:REGION, parts:I,J or not:I,J");
    return *std::move(choice);
}

void add_time(const Command& command, GridOptions& grid) {
    const OptionGroup group(command, "Time steps");
    const Option time =
        command.add_number("--time", [&](double t) { grid.time = t; }, "T", "The time step with this time");
    command
        .add_count(
            "--step", {}, [&](std::uint64_t n) { grid.step = n; }, "N", "The time step with this number, from 0")
        .excludes(time);
}

void add_reading(const Command& command, GridOptions& grid, const std::string& format_option) {
    const OptionGroup group(command, "Reading");
    command.add_text(format_option, grid.format, "FORMAT",
                     "Format of the grid; default: content decides, then the name");
    command.add_texts(
        "--block", [&](const std::vector<std::string>& names) { grid.blocks = names; }, "NAME|NUMBER",
        "Read only this block, zone, part or region of the file, by its name or number as info lists them; may be "
        "repeated");
    command.add_texts(
        "--cells", [&](const std::vector<std::string>& cells) { grid.cells = cells; }, "FIELD=LIST",
        "Keep only cells with these values of a cell field: numbers, ranges A:B, names of regions, as in "
        "region=2,5:7,sand; all others: !FIELD=LIST; may be repeated: all must hold");
    command.add_text("--displace", grid.displace, "FIELD", "Move the points by this vector field");
    command.add_number(
        "--merge-points", [&](double t) { grid.merge_points = t; }, "TOLERANCE",
        "Merge points closer than this; 0: exactly equal coordinates. Refused when every cell collapses");
    command
        .add_choice<MergedValues>(
            "--merge-values", grid.merge_values, {{"lowest", MergedValues::lowest}, {"mean", MergedValues::mean}},
            "Value of merged points where a field jumps: that of the lowest-numbered, or the mean")
        .needs(command.option("--merge-points"));
    command.add_choice<HangingChoice>(
        "--hanging-points", grid.hanging_points,
        {{"close", HangingChoice::close}, {"interpolate", HangingChoice::interpolate}, {"leave", HangingChoice::leave}},
        "Points that hang on faces and edges of larger cells: close gives them to these cells; interpolate also takes "
        "their values from these cells; leave leaves the surface open there");
    command.add_flag("--keep-pieces", grid.keep_pieces,
                     "Do not join points of different pieces that have equal coordinates");
    command.add_flag("--allow-outside", grid.allow_outside,
                     "Index files (.pvd, .pvtu and so on) may name files outside their own folder");
}

void add_compression(const Command& command, Compression& compression, const char* format) {
    command.add_choice<Compression>(
        "--compress", compression,
        {{"none", Compression::none}, {"zlib", Compression::zlib}, {"lz4", Compression::lz4}},
        fmt::format("Packs the arrays of {}: by zlib, which every VTK reads, or by LZ4, which is read faster", format));
}

Option add_field(const Command& command, FieldChoice& field, const std::string& description) {
    const Option name = command.add_text("-f,--field", field.name, "FIELD", description);
    command.add_flag("--cell-field", field.cell_field, "Use the cell field if a point field has the same name");
    return name;
}

void add_centre(const Command& command, FieldChoice& field) {
    command.add_value(
        "--centre",
        [&field](const std::string& text) {
            if (text != "mean" && text != "own") refuse_value("--centre", text, "mean or own");
            field.own_centres = text == "own";
        },
        "mean|own",
        "Polyhedra, of a cell field: the value at the point inside around which a polyhedron is split is the mean of "
        "its points (default), or the cell's own: sharper, and beyond the values around");
}

namespace {

constexpr const char* more_files_text = "Files of further time steps, taken in the order of the numbers in their names";

void add_step(const std::string& option, const std::string& name, GridOptions& grid) {
    if (name.empty()) refuse_value(option, name, "the name of a file");
    grid.more_files.push_back(name);
    if (comes_before(name, grid.file)) std::swap(grid.more_files.back(), grid.file);
    std::ranges::stable_sort(grid.more_files, comes_before);
}

/// Whether a name can be one of a grid only.
bool is_of_grid(const std::string& name) {
    const FileKinds kinds = kinds_of(name);
    return kinds.grid && !kinds.surface;
}

} // namespace

void add_more_files(const Command& command, GridOptions& grid) {
    command.add_texts(
        "MORE",
        [&grid](const std::vector<std::string>& names) {
            for (const std::string& name : names) {
                refuse_loose_number(name);
                add_step("MORE", name, grid);
            }
        },
        "FILES", more_files_text);
}

void add_out_and_more_files(const Command& command, GridOptions& grid, std::string& out, const std::string& what) {
    const auto by_place = std::make_shared<bool>(false); // OUT was given by its place
    const auto take = [&grid, &out, by_place](const std::string& option, const std::string& name) {
        if (name.empty()) refuse_value(option, name, "the name of a file");
        const bool is_named = !out.empty() && !*by_place; // by -o
        if (is_of_grid(name) || (is_named && kinds_of(name).grid)) return add_step(option, name, grid);
        if (is_named) refuse_value(option, name, "nothing beside -o but grids of further time steps");
        if (*by_place) add_step(option, out, grid); // the last one is OUT
        out = name;
        *by_place = true;
    };
    command.add_value("OUT", [take](const std::string& name) { take("OUT", name); }, "OUT_FILE", what);
    command.add_texts(
        "MORE",
        [take](const std::vector<std::string>& names) {
            for (const std::string& name : names) {
                refuse_loose_number(name);
                take("MORE", name);
            }
        },
        "FILES", std::string(more_files_text) + "; OUT is then the last name");
}

/// "0,2" as 0.2; nothing for other text.
std::optional<double> with_decimal_comma(std::string text) {
    const std::size_t comma = text.find(',');
    if (comma == std::string::npos || text.find_first_not_of("-0123456789,") != std::string::npos) return {};
    text[comma] = '.';
    return parse_number(text);
}

double parse_end(const std::string& option, std::string_view text) {
    const std::optional<double> number = parse_number(text);
    if (!number) refuse_value(option, text, "a finite number, or a share such as 90%v or p95");
    return *number;
}

SolidRange parse_range(const std::string& option, const std::string& text, RangeShares& shares) {
    const std::size_t colon = text.find(':');
    SolidRange out;
    const bool divided = colon != std::string::npos;
    const std::string_view first = std::string_view(text).substr(0, colon);
    const std::string_view second = divided ? std::string_view(text).substr(colon + 1) : std::string_view();
    shares = {parse_share(first), parse_share(second)};
    const std::optional<double> lower = parse_number(first), upper = parse_number(second);
    if (lower) out.lower = *lower;
    if (upper) out.upper = *upper;
    if (!divided || (!lower && !shares.lower) || (!upper && !shares.upper) || !(out.lower < out.upper))
        refuse_value(option, text, "two isovalues A:B, A below B: numbers, or shares such as 90%v");
    return out;
}

Option add_isovalues(const Command& command, std::vector<double>& isovalues, std::vector<IsovalueShare>& shares,
                     std::optional<double>* decimal_comma) {
    return command.add_numbers("-i,--isovalue", isovalues, "V[,W...]",
                               "Isovalues, separated by commas: numbers, 90%v (with 90 % of the grid's volume below), "
                               "p95 (95th percentile of the point values); or @NAME: from that file, separated by "
                               "blanks, commas or line ends, # begins a comment; may be repeated",
                               {[&shares](std::string_view word) {
                                    const std::optional<IsovalueShare> share = parse_share(word);
                                    if (share) shares.push_back(*share);
                                    return share.has_value();
                                },
                                "finite numbers, or shares such as 90%v or p95",
                                [decimal_comma](const std::vector<std::string>& lists) {
                                    if (decimal_comma && lists.size() == 1)
                                        *decimal_comma = with_decimal_comma(lists.front());
                                }});
}

void add_device(const Command& command, DeviceChoice& choice) {
    const OptionGroup group(command, "Method and machine");
    command.add_value(
        "--device",
        [&choice](const std::string& name) {
            if (name.empty()) refuse_value("--device", name, "a device of isotet devices, software or none");
            choice.name = name;
        },
        "DEVICE",
        "The Vulkan device: its number or a part of its name in isotet devices, software, or none; default: the best "
        "graphics card");
}

void add_refinement(const Command& command, RefineChoice& refine, bool* asked) {
    const OptionGroup group(command, "Curved cells");
    const auto number = [](const std::string& name, const std::string& text, std::size_t size, const char* rule) {
        double value = 0;
        const char* const end = text.data() + size;
        const auto [stopped, fault] = std::from_chars(text.data(), end, value);
        if (fault != std::errc{} || stopped != end || !std::isfinite(value) || value <= 0)
            refuse_value(name, text, rule);
        return value;
    };
    // Options are taken in this order, whatever the order on the command line.
    const auto given = std::make_shared<bool>(false);
    command.add_value(
        "--tolerance",
        [&refine, number, given, asked](const std::string& text) {
            *given = true;
            if (asked) *asked = true;
            if (text == "nodes") {
                refine.reset();
                return;
            }
            const bool percent = text.ends_with('%');
            const double value = number("--tolerance", text, text.size() - (percent ? 1 : 0),
                                        "a number above 0, one with %, such as 0.1%, or nodes");
            (percent ? refine->relative_tolerance : refine->tolerance) = percent ? value / 100 : value;
        },
        "T|P%|nodes",
        "Quadratic cells: largest error of the field, in its unit or in % of its range, default: 0.1%; nodes splits "
        "cells at their nodes, without a bound: the default for averaged cell fields");
    const auto add_length = [&](const std::string& name, auto set, const char* help) {
        command.add_value(
            name,
            [&refine, number, name, set, asked](const std::string& text) {
                if (asked) *asked = true;
                const double value = number(name, text, text.size(), "a number above 0");
                if (!refine)
                    refuse_value(name, text, "a distance only where cells are refined: not with --tolerance nodes");
                set(*refine, value);
            },
            "D", help);
    };
    add_length(
        "--distance",
        [given](RefineOptions& options, double value) {
            options.distance = value;
            if (!*given) options.relative_tolerance = 0;
        },
        "Quadratic cells: largest distance of the surface from that of the quadratic field, by estimate; in place of "
        "--tolerance, or beside it");
    add_length(
        "--geometry-tolerance", [](RefineOptions& options, double value) { options.geometry_tolerance = value; },
        "Quadratic cells: largest distance of the tets from the curved cells; default: a hundredth of each edge's "
        "length");
}

void add_common(const Command& command, CommonOptions& common) {
    const OptionGroup group(command, "Threads and messages");
    command.add_file("--json", common.json, "FILE",
                     "Write the numbers as JSON too; - is standard output, which then has no table");
    command.add_count(
        "-j,--threads", {0, 4096}, [&](std::uint64_t n) { common.threads = static_cast<int>(n); }, "N",
        "Threads; 0 or not given: all");
    const Option quiet = command.add_flag("-q,--quiet", common.quiet, "No table, no notes, no progress: only errors");
    command.add_flag("-v,--verbose", common.verbose, "Say more").excludes(quiet);
}

void add_grid_and_surface(const Command& command, ExtractJob& job) {
    command.add_file("FILE", job.grid.file, "FILE", "A grid: a file, or make:SHAPE:SIDE[:FIELDS]").required();
    command.add_file("-o,--output", job.out, "OUT_FILE", "The surface; the ending says the format");
    add_out_and_more_files(command, job.grid, job.out, "The surface, as -o");
}

namespace {

void add_parts_and_solids(const Command& command, ExtractJob& job, const std::string& solids) {
    const OptionGroup group(command, "Solids, parts, pieces");
    command.add_value(
        "--piece", [&job](const std::string& text) { job.piece = parse_piece(text); }, "K/N",
        "Only piece K, from 1, of N: the surfaces of all N together are that of the whole grid, bit for bit");
    command.add_value(
        "--solid", [&job](const std::string& text) { job.solid = parse_solid(text); }, "above|below|A:B", solids);
    command.add_value(
        "--keep", [&job](const std::string& text) { job.keep = parse_parts(text); },
        "largest|N|area>A|volume>V|touching:REGION|parts:I[,J]|not:I[,J]",
        "Only these connected parts of each surface or solid: the largest by area, the N largest, those of more area "
        "or volume, those that touch boundary, a region or cells with FIELD=VALUE, or by their numbers in --parts");
    command.add_file("--parts", job.parts_table, "FILE.csv",
                     "Write a table of the connected parts: triangles, area, volume, place, means of the fields");
    command.add_value(
        "--reduce", [&job](const std::string& text) { wanted_reduction(job).share = parse_reduction(text); }, "SHARE",
        "Leave out this share of the triangles, such as 90%, where that moves the surface least; closed solids stay "
        "closed");
    command.add_number(
        "--reduce-error", [&job](double error) { wanted_reduction(job).error = error; }, "E",
        "Leave out triangles while the surface moves by no more than about E, a mean; without --reduce up to 99 %");
    command.add_flag("--keep-degenerate", job.keep_degenerate,
                     "One vertex for every active edge and one or two triangles for every active tet, ties or not");
    command.add_flag("--volumes", job.volumes,
                     "Report the volume of the grid where the field is below each isovalue, and where it is above");
    command.add_flag("--fail-if-empty", job.fail_if_empty,
                     "An empty surface is an error, exit status 3, and is not written");
    command
        .add_flag(
            "--allow-empty", job.allow_empty,
            "Write empty surfaces also where all isovalues are outside the range of the field, which else is an error")
        .excludes(command.option("--fail-if-empty"));
}

void add_method(const Command& command, ExtractJob& job) {
    const OptionGroup group(command, "Method and machine");
    command.add_choice<Precision>("--precision", job.contour.precision,
                                  {{"float", Precision::float32}, {"double", Precision::float64}},
                                  "Precision of the packed grid");
    command.add_choice<std::optional<Method>>(
        "--method", job.contour.method,
        {{"auto", std::nullopt}, {"clusters", Method::clusters}, {"direct", Method::direct}},
        "clusters packs the grid once, which pays for many surfaces; direct goes through all cells for each; auto "
        "chooses by their number");
    command.add_choice<EngineChoice>("--engine", job.engine,
                                     {{"auto", EngineChoice::automatic},
                                      {"cpu", EngineChoice::cpu},
                                      {"vulkan", EngineChoice::vulkan},
                                      {"reference", EngineChoice::reference}},
                                     "What extracts: auto is the CPU, or the device that --device names, with the CPU "
                                     "where that fails; vulkan is a device or an error; reference is slow and obvious");
}

} // namespace

void add_surface_options(const Command& command, ExtractJob& job, const std::string& solids) {
    add_time(command, job.grid);
    {
        const OptionGroup group(command, "Time steps");
        command.add_flag("--all-steps", job.all_steps, "Every time step; OUT then needs {step} or {time}")
            .excludes(command.option("--time"))
            .excludes(command.option("--step"));
        add_interpolate(command, job.interpolate, "surfaces");
    }
    add_surface_arrays(command, job);
    add_refinement(command, job.contour.refine, &job.refine_averaged);
    add_parts_and_solids(command, job, solids);
    {
        const OptionGroup group(command, "Colours and files");
        command.add_text(
            "--color-by", job.colors.by, "FIELD",
            "Colour vertices by this point field: vertex colours in .glb, .ply and .usda, a field rgb in .vtp "
            "and .vtk");
        add_color_scale(command, job.colors.scale, job.colors.range);
        add_compression(command, job.compression, ".vtp");
    }
    add_method(command, job);
    add_device(command, job.device);
    add_device_memory(command, job.device);
    add_reading(command, job.grid, "--format");
    add_memory(command, job.memory);
}

void add_device_memory(const Command& command, DeviceChoice& choice) {
    const OptionGroup group(command, "Method and machine");
    add_bytes(command, "--device-memory", choice.memory,
              "Memory of the device to take at most, such as 2GB; default: what is free");
}

void add_commands(const Command& program, CommandLine& line) {
    program.set_details(program_details);
    program.add_flag("--version", line.version, "Print the version and the facts of the build");
    add_info(program, line.info);
    add_extract(program, line.extract);
    add_slice_command(program, line.slice);
    add_clip_command(program, line.clip);
    add_render(program, line.render);
    add_view(program, line.view);
    add_export(program, line.exported);
    add_page(program, line.page);
    add_bench(program, line.bench);
    add_check(program, line.check);
    add_pack(program, line.pack);
    add_make(program, line.make);
    add_formats(program, line.formats);
    add_devices(program, line.devices);
    add_help(program, line.topic);
    add_docs(program, line.docs);
}

} // namespace isotet::cli
