// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "option_tree.hpp"

#include "bench_options.hpp"
#include "device_choice.hpp"
#include "option_values.hpp"
#include "render_options.hpp"

namespace isotet::cli {

namespace {

constexpr const char* program_details = R"(
isotet FILE is short for isotet info FILE. FILE may be make:SHAPE:SIDE[:FIELDS] wherever a grid is read: a test grid
made in memory, make:kuhn:64:gyroid for example.

Tables go to standard output, notes and errors to standard error. Ctrl-C stops within a second and leaves no half
written file; a second Ctrl-C ends the program at once.

Exit status:
  0    done
  1    a check says no
  2    usage: an option or a name is wrong
  3    a file, or the data in it
  4    the machine: memory, disk, device, standard output
  5    a fault of isotet: please report it
  130  interrupted
)";

constexpr const char* info_details = R"(
A field's range is that of its finite values; no data is the number of NaN. Inverted tets are those whose sign is not
that of most; boundary faces are those that the tets do not use equally often in both directions.
)";

constexpr const char* extract_details = R"(
FIELD is taken whole first; only if no field has that name is the part after the last colon a component: x, y, z, mag,
or a number from 0. x, y and z alone are the coordinates, unless fields are called so. A cell field is averaged to the
points, weighted by volume.

OUT ends in .vtp, .ply, .stl, .obj, .vtk or .ts. Several isovalues in one OUT make one surface with a cell field
isovalue; with {value} or {time} in OUT there is one file each, named by the shortest decimal that reads back. Files
that were complete when Ctrl-C came stay. Without OUT only the numbers are printed. Without an isovalue the middle of
the range is taken.

A point whose value equals the isovalue counts as above it. Triangles face the side of higher values. All methods give the
same vertices and triangles, but not in the same order: where the bytes of a file must be the same everywhere, name the
method. What auto expects follows from a look at some of the cells and from speeds: those of this machine where the work
takes over four seconds (measured once, in two, and kept in XDG_CACHE_HOME/isotet), typical ones otherwise.

Examples:
  isotet extract grid.vtu surface.vtp -f pressure -i 0.5
  isotet extract grid.e 'shell-{value}.stl' -f temp -i 300,350,400
  isotet extract run.pvd 'front-{time}.vtp' -f c -i 0.5 --all-steps
  isotet extract make:kuhn:64:gyroid -i 0
  isotet extract grid.vtu surface.vtp -f pressure -i 0.5 --engine vulkan
)";

constexpr const char* check_details = R"(
Says no (exit status 1) when the surface has: an edge that is used unequally often in the two directions where it must
not be; a triangle with two equal corners; a triangle that occurs twice in the same direction.

Where edges must be used equally often: with --closed everywhere; with --grid everywhere except on edges whose grid
points all lie in one boundary face of the grid's valid tets; with neither they are only counted. --grid needs the
point array edge_ends, which isotet extract --edge-ends writes into .vtp and .vtk, and excuses a repeated triangle on
a face with two tets on one side. A tet is valid when the field has a value (not NaN) at its four points.

With --strict it also says no to: triangles of zero area, edges with more than two triangles, double sheets (two
triangles on the same corners in opposite directions), touching vertices (triangles that are not one fan), coincident
vertices.

STL has no vertex numbers: its triangles are welded by exact coordinates first. What that collapses is counted, not
blamed.
)";

constexpr const char* make_details = R"(
Shapes, on the cube from -1 to 1: kuhn (six tets a cube), perturbed (inner points moved), shuffled (perturbed, points
and tets in random order), layer (cells of aspect ratio up to 1000), hex, wedge, pyramid, mixed (all four cell types).
The same bytes for any number of threads.

Fields: sphere, torus, plane, gyroid, wavelet, integer (many ties).

Examples:
  isotet make kuhn --side 64 -o kuhn.vtu
  isotet make mixed --side 20 --fields sphere,integer -o mixed.vtk
)";

constexpr const char* formats_details = R"(--format takes the names in the first column.
)";

constexpr const char* devices_details = R"(
A device can be used when it has Vulkan 1.2 and what the engine needs; of one that cannot, the reason is told. Software
devices are used only when asked for, by --device software. Without Vulkan, or without a device, isotet works on the CPU.

With --device that device is opened, and its arithmetic is compared with the processor's, bit by bit: in a few thousand
cases that are hard to round. Where they differ, surfaces may differ from the CPU's in their last bits, and every command
that uses the device says so.
)";

void add_common(CLI::App& app, CommonOptions& common) {
    add_file(app, "--json", common.json, "FILE",
             "Write the numbers as JSON too; - is standard output, which then has no table");
    add_count(
        app, "-j,--threads", {0, 4096}, [&](std::uint64_t n) { common.threads = static_cast<int>(n); }, "N",
        "Threads; 0, and without it: all");
    CLI::Option* quiet = app.add_flag("-q,--quiet", common.quiet, "No table, no notes, no progress: only errors");
    app.add_flag("-v,--verbose", common.verbose, "Say more")->excludes(quiet);
}

void add_time(CLI::App& app, GridOptions& grid) {
    CLI::Option* time =
        add_number(app, "--time", [&](double t) { grid.time = t; }, "T", "The time step with this time");
    add_count(
        app, "--step", {}, [&](std::uint64_t n) { grid.step = n; }, "N", "The time step with this number, from 0")
        ->excludes(time);
}

void add_reading(CLI::App& app, GridOptions& grid, const std::string& format_option) {
    add_text(app, format_option, grid.format, "FORMAT",
             "Format of the grid; without it content decides, then the name");
    add_text(app, "--displace", grid.displace, "FIELD", "Move the points by this vector field");
    add_number(
        app, "--merge-points", [&](double t) { grid.merge_points = t; }, "TOLERANCE",
        "Weld points closer than this; 0: exactly equal coordinates");
    app.add_flag("--merge-pieces", grid.merge_pieces, "Join pieces without global ids by exact coordinates");
    app.add_flag("--allow-outside", grid.allow_outside, "Index files may name files outside their own folder");
}

CLI::App& add_info(CLI::App& program, InfoCommand& info) {
    CLI::App& app = *program.add_subcommand("info", "Tell what a grid file holds");
    add_file(app, "FILE", info.grid.file, "FILE", "A grid: a file, or make:SHAPE:SIDE[:FIELDS]")->required();
    add_time(app, info.grid);
    add_reading(app, info.grid, "--format");
    add_common(app, info.common);
    app.footer(info_details);
    return app;
}

void add_isovalues(CLI::App& app, ExtractCommand& extract) {
    CLI::Option* isovalues = add_numbers(app, "-i,--isovalue", extract.isovalues, "V[,W...]",
                                         "Isovalues, separated by commas; may be repeated");
    add_count(
        app, "--levels", {1, 1'000'000}, [&](std::uint64_t n) { extract.levels = n; }, "N",
        "N isovalues evenly inside the range of the field at each time step: min + k (max - min) / (N + 1), k = 1..N")
        ->excludes(isovalues);
    app.add_flag("--snap", extract.snap,
                 "Take the nearest value that the field's type can hold: 0.7 becomes 0.699999988 on float32");
}

void add_surface_arrays(CLI::App& app, ExtractCommand& extract) {
    add_choice<Normals>(app, "--normals", extract.normals,
                        {{"none", Normals::none}, {"gradient", Normals::gradient}, {"face", Normals::face}},
                        "Normals: of the field's gradient, a vertex; of the triangles, a face");
    app.add_option_function<std::vector<std::string>>(
           "--with", [&](const std::vector<std::string>& names) { extract.with = names; },
           "Carry this point or cell field onto the surface; may be repeated; an empty name carries none. Without it: "
           "point fields that the format can hold")
        ->type_name("FIELD")
        ->allow_extra_args(false);
    app.add_flag(
        "--edge-ends", extract.edge_ends,
        "Write the two grid points of each vertex (edge_ends) and its place between them (edge_weights); .vtp, .vtk");
    app.add_flag("--source-cells", extract.source_cells,
                 "Write the grid cell of each triangle (source_cell); .vtp, .vtk");
}

CLI::App& add_extract(CLI::App& program, ExtractCommand& extract) {
    CLI::App& app = *program.add_subcommand("extract", "Extract isosurfaces and write them into files");
    add_file(app, "FILE", extract.grid.file, "FILE", "A grid: a file, or make:SHAPE:SIDE[:FIELDS]")->required();
    CLI::Option* out = add_file(app, "OUT", extract.out, "OUT_FILE", "The surface, as -o");
    add_file(app, "-o,--output", extract.out, "OUT_FILE", "The surface; the ending says the format")->excludes(out);
    add_text(app, "-f,--field", extract.field.name, "FIELD",
             "The field to contour; may be left out where there is only one");
    app.add_flag("--cell-field", extract.field.cell_field,
                 "Of a name that is both a point and a cell field, the cell field");
    add_isovalues(app, extract);
    add_time(app, extract.grid);
    app.add_flag("--all-steps", extract.all_steps, "Every time step; OUT then needs {time}")
        ->excludes(app.get_option("--time"))
        ->excludes(app.get_option("--step"));
    add_surface_arrays(app, extract);
    app.add_flag("--keep-degenerate", extract.keep_degenerate,
                 "One vertex for every crossed edge and one or two triangles for every cut tet, ties or not");
    add_choice<Precision>(app, "--precision", extract.precision,
                          {{"float", Precision::single}, {"double", Precision::double_}},
                          "Precision of the packed grid");
    add_choice<MethodChoice>(
        app, "--method", extract.method,
        {{"auto", MethodChoice::automatic}, {"clusters", MethodChoice::clusters}, {"brute", MethodChoice::brute}},
        "How: clusters packs the grid first, which pays for many surfaces; brute goes through all cells for each "
        "surface; auto "
        "takes what is expected to be done first within the memory that is free, and says why");
    add_choice<EngineChoice>(app, "--engine", extract.engine,
                             {{"auto", EngineChoice::automatic},
                              {"cpu", EngineChoice::cpu},
                              {"vulkan", EngineChoice::vulkan},
                              {"reference", EngineChoice::reference}},
                             "What extracts: auto is the device that --device names, with the CPU where that fails, or "
                             "without --device the CPU, or "
                             "a graphics card where that is expected to be faster; vulkan is a device or an error; "
                             "reference is slow and obvious");
    add_device(app, extract.device);
    add_device_memory(app, extract.device);
    add_reading(app, extract.grid, "--format");
    add_common(app, extract.common);
    app.footer(extract_details);
    return app;
}

CLI::App& add_render(CLI::App& program, RenderCommand& render) {
    CLI::App& app = add_render_command(program, render);
    add_device(app, render.device);
    add_device_memory(app, render.device);
    add_time(app, render.grid);
    add_reading(app, render.grid, "--format");
    add_common(app, render.common);
    return app;
}

CLI::App& add_bench(CLI::App& program, BenchCommand& bench) {
    CLI::App& app = add_bench_command(program, bench);
    add_device(app, bench.device);
    add_device_memory(app, bench.device);
    add_time(app, bench.grid);
    add_reading(app, bench.grid, "--format");
    for (const char* name : {"--time", "--step", "--format", "--displace", "--merge-points", "--merge-pieces",
                             "--allow-outside", "--cell-field"})
        app.get_option(name)->excludes(app.get_option("--paper"));
    add_common(app, bench.common);
    return app;
}

CLI::App& add_check(CLI::App& program, CheckCommand& check) {
    CLI::App& app = *program.add_subcommand("check", "Measure a surface and look for what should not be there");
    add_file(app, "SURFACE", check.surface, "SURFACE_FILE", "A surface: .vtp, .ply, .stl, .obj, .vtk or .ts")
        ->required();
    app.add_flag("--closed", check.closed, "Blame every edge that is used unequally often in the two directions");
    CLI::Option* grid = add_file(app, "--grid", check.grid.file, "FILE",
                                 "Blame such edges unless they lie in one boundary face of this grid");
    add_text(app, "-f,--field", check.field.name, "FIELD",
             "The field that was contoured: tets without a value do not count")
        ->needs(grid);
    app.add_flag("--cell-field", check.field.cell_field,
                 "Of a name that is both a point and a cell field, the cell field")
        ->needs(grid);
    add_time(app, check.grid);
    app.add_flag("--strict", check.strict, "Say no to more: see below");
    add_text(app, "--format", check.format, "FORMAT", "Format of the surface; without it the name decides");
    add_reading(app, check.grid, "--grid-format");
    for (const char* name : {"--time", "--step", "--grid-format", "--displace", "--merge-points", "--merge-pieces"}) {
        app.get_option(name)->needs(grid);
    }
    add_common(app, check.common);
    app.footer(check_details);
    return app;
}

CLI::App& add_make(CLI::App& program, MakeCommand& make) {
    CLI::App& app = *program.add_subcommand("make", "Make a test grid with analytic fields");
    add_text(app, "SHAPE", make.grid.shape, "SHAPE", "kuhn, perturbed, shuffled, layer, hex, wedge, pyramid or mixed")
        ->required();
    add_count(app, "--side", {1}, [&](std::uint64_t n) { make.grid.side = n; }, "N", "Cubes along an edge")->required();
    app.add_option("--fields", make.grid.fields, "Fields, separated by commas; without it sphere,gyroid")
        ->type_name("A[,B...]")
        ->delimiter(',')
        ->allow_extra_args(false);
    add_count(
        app, "--seed", {}, [&](std::uint64_t n) { make.grid.seed = n; }, "N", "Seed of what is random; without it 1");
    add_file(app, "-o,--output", make.out, "OUT_FILE", "The grid: .vtu or .vtk")->required();
    add_common(app, make.common);
    app.footer(make_details);
    return app;
}

CLI::App& add_formats(CLI::App& program, FormatsCommand& formats) {
    CLI::App& app = *program.add_subcommand("formats", "List the file formats");
    add_common(app, formats.common);
    app.footer(formats_details);
    return app;
}

CLI::App& add_devices(CLI::App& program, DevicesCommand& devices) {
    CLI::App& app = *program.add_subcommand("devices", "List the graphics cards and other Vulkan devices");
    add_device(app, devices.device);
    add_common(app, devices.common);
    app.footer(devices_details);
    return app;
}

CLI::App& add_docs(CLI::App& program, DocsCommand& docs) {
    CLI::App& app = *program.add_subcommand("docs", "Print the man page, the bash completion or docs/command-line.md");
    app.add_option("KIND", docs.kind)->required()->type_name("man|completion|markdown");
    app.group(""); // for the build, not for users
    return app;
}

} // namespace

std::unique_ptr<CLI::App> make_option_tree(CommandLine& line) {
    auto program = std::make_unique<CLI::App>("Isosurfaces of very large unstructured tetrahedral grids", "isotet");
    program->footer(program_details);
    program->add_flag("--version", line.version, "Print the version and the facts of the build");
    program->require_subcommand(0, 1);
    for (CLI::App* command :
         {&add_info(*program, line.info), &add_extract(*program, line.extract), &add_render(*program, line.render),
          &add_bench(*program, line.bench), &add_check(*program, line.check), &add_make(*program, line.make),
          &add_formats(*program, line.formats), &add_devices(*program, line.devices), &add_docs(*program, line.docs)}) {
        command->callback([&line, command] { line.command = command->get_name(); });
    }
    return program;
}

} // namespace isotet::cli
