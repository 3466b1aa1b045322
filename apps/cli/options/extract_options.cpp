// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "options/command_options.hpp"

#include <charconv>

namespace isotet::cli {

namespace {

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

PartChoice parse_parts(const std::string& text) {
    std::optional<PartChoice> choice = parse_part_choice(text);
    if (!choice)
        refuse_value("--keep", text,
                     "largest, a number of parts from 1, area>A, volume>V, touching:REGION, parts:I,J or not:I,J");
    return *std::move(choice);
}

void add_grid_and_surface(const Command& command, ExtractJob& job) {
    command.add_file("FILE", job.grid.file, "FILE", "A grid: a file, or make:SHAPE:SIDE[:FIELDS]").required();
    command.add_file("-o,--output", job.out, "OUT_FILE", "The surface; the ending says the format");
    add_out_and_more_files(command, job.grid, job.out, "The surface, as -o");
}

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

void add_extract_command(const Command& program, ExtractCommand& extract) {
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

} // namespace isotet::cli
