// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "options/command_options.hpp"

namespace isotet::cli {

namespace {

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

void add_bench(const Command& program, BenchCommand& bench) {
    const Command command = add_bench_command(program, bench);
    add_machine_and_input(command, bench.device, bench.grid, bench.common);
    for (const char* name : {"--time", "--step", "--format", "--block", "--displace", "--merge-points", "--keep-pieces",
                             "--allow-outside", "--cell-field"})
        command.option(name).excludes(command.option("--paper"));
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

void add_commands(const Command& program, CommandLine& line) {
    program.set_details(program_details);
    program.add_flag("--version", line.version, "Print the version and the facts of the build");
    add_info_command(program, line.info);
    add_extract_command(program, line.extract);
    add_slice_command(program, line.slice);
    add_clip_command(program, line.clip);
    add_render(program, line.render);
    add_view_command(program, line.view);
    add_export_command(program, line.exported);
    add_page_command(program, line.page);
    add_bench(program, line.bench);
    add_check_command(program, line.check);
    add_pack_command(program, line.pack);
    add_make(program, line.make);
    add_formats(program, line.formats);
    add_devices(program, line.devices);
    add_help(program, line.topic);
    add_docs(program, line.docs);
}

} // namespace isotet::cli
