// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "command_options.hpp"
#include "number_format.hpp"

namespace isotet::cli {

namespace {

constexpr const char* render_details = R"(
FILE is a grid or a surface. With nothing but FILE the field that varies most is taken, with three isovalues between the
ends of its range (rare values at the ends aside), each in its own colour. FIELD is found as by isotet extract.

The picture is as large as possible in its frame, z upwards; +x looks from the end of the x axis. OUT ends in .png;
without it the picture gets FILE's name, in the current folder. The pictures of --sweep and --orbit are numbered from 1
where {frame} stands in OUT, or go into one animated file when OUT ends in .webp.

A graphics card draws, if there is one; otherwise, or with --device software, a software device, with a note. If there
is neither, nothing can be drawn: on Debian the package mesa-vulkan-drivers has a software device. On one device the same
command gives the same bytes.

Examples:
  isotet render grid.vtu
  isotet render grid.vtu pressure.png -f pressure -i 0.5
  isotet render surface.vtp --view +x --size 800x600 --background transparent
  isotet render grid.vtu -f pressure --sweep 0,1,50 -o sweep.webp
  isotet render grid.vtu -f pressure -i 0.5 --orbit 90 -o 'frame{frame}.png'
)";

void add_size(const Command& command, PictureOptions& picture) {
    command.add_value(
        "--size",
        [&picture](const std::string& text) {
            const std::size_t cross = text.find('x');
            const auto width = parse_count(text.substr(0, cross));
            const auto height = parse_count(cross == std::string::npos ? "" : text.substr(cross + 1));
            if (!width || !height || *width < 1 || *height < 1 || *width > 32768 || *height > 32768)
                refuse_value("--size", text, "width x height in pixels, 1 to 32768 each, such as 1200x900");
            picture.width = static_cast<std::uint32_t>(*width);
            picture.height = static_cast<std::uint32_t>(*height);
        },
        "WxH", "Width and height of the picture in pixels; without it 1200x900");
}

/// A number from 0 to 1.
void add_part(const Command& command, const std::string& name, std::optional<double>& part,
              const std::string& description) {
    command.add_number(
        name,
        [&part, name](double number) {
            if (number < 0 || number > 1) refuse_value(name, shortest(number), "a number from 0 to 1");
            part = number;
        },
        "OPACITY", description);
}

void add_color(const Command& command, const std::string& name, Color& color, const std::string& description) {
    command.add_value(
        name,
        [&color, name](const std::string& text) {
            const std::optional<Color> parsed = parse_color(text);
            if (!parsed) refuse_value(name, text, "white, black, transparent, another plain colour, or #rrggbb");
            color = *parsed;
        },
        "COLOR", description);
}

} // namespace

Command add_render_command(const Command& program, RenderCommand& render) {
    const Command command = program.add_command("render", "Draw isosurfaces, or a surface, into a picture");
    command.add_file("FILE", render.grid.file, "FILE", "A grid or a surface: a file, or make:SHAPE:SIDE[:FIELDS]")
        .required();
    const Option out = command.add_file("OUT", render.out, "OUT_FILE", "The picture, as -o");
    command.add_file("-o,--output", render.out, "OUT_FILE", "The picture, .png; many: {frame} in the name, or .webp")
        .excludes(out);
    add_field(command, render.field, "The field to contour; without it the one that varies most");
    const Option isovalues = add_isovalues(command, render.isovalues);
    command
        .add_count(
            "--levels", {1, 100}, [&](std::uint64_t n) { render.levels = n; }, "N",
            "N isovalues at round numbers evenly inside the range of the field; without it 3")
        .excludes(isovalues);
    const Option sweep = command.add_numbers("--sweep", render.sweep, "A,B,N", "N pictures, at isovalues from A to B")
                             .excludes(isovalues);
    sweep.excludes(command.option("--levels"));
    const Option orbit = command.add_count(
        "--orbit", {2, 100'000}, [&](std::uint64_t n) { render.orbit = n; }, "N",
        "N pictures, once around from the left to the right");
    orbit.excludes(sweep);
    command.add_number(
        "--fps",
        [&](double rate) {
            if (rate <= 0 || rate > 100)
                refuse_value("--fps", shortest(rate), "pictures a second, above 0 and up to 100");
            render.frames_per_second = rate;
        },
        "RATE", "Pictures a second of an animated OUT; without it 12");
    add_part(command, "--boundary", render.boundary, "Opacity of the grid's boundary, 0 to 1; without it 0.1");
    command.add_flag("--outline", render.outline, "Draw the edges of the box around");
    add_part(command, "--opacity", render.opacity,
             "Opacity of the surfaces, 0 to 1; without it 1, and of several isosurfaces 0.35 for all but the smallest");
    add_size(command, render.picture);
    command.add_choice<View>("--view", render.view,
                             {{"iso", View::iso},
                              {"+x", View::plus_x},
                              {"-x", View::minus_x},
                              {"+y", View::plus_y},
                              {"-y", View::minus_y},
                              {"+z", View::plus_z},
                              {"-z", View::minus_z}},
                             "From where one looks; without it iso, obliquely from above");
    command.add_flag("--parallel", render.parallel, "Without perspective: what is farther away is not smaller");
    command.add_choice<EngineChoice>(
        "--engine", render.engine,
        {{"auto", EngineChoice::automatic}, {"cpu", EngineChoice::cpu}, {"vulkan", EngineChoice::vulkan}},
        "What extracts: auto is the device that draws if it is a graphics card, so that surfaces stay there, else the "
        "CPU");
    std::vector<std::pair<std::string, RenderMethod>> methods{
        {"auto", {}}, {"direct", {Method::direct, {}}}, {"clusters", {Method::clusters, {}}}};
    for (const DrawMethod method : all_draw_methods) methods.push_back({std::string(name_of(method)), {{}, method}});
    command.add_choice("--method", render.method, methods,
                       "How: auto, direct and clusters extract surfaces, as isotet extract does; the others are "
                       "earlier methods that draw tets and make no surface, to be compared with; without it auto");
    std::vector<std::pair<std::string, std::optional<SearchIndex>>> indexes;
    for (const SearchIndex index : all_search_indexes) indexes.emplace_back(name_of(index), index);
    command.add_choice("--index", render.index, indexes,
                       "Search index that finds the active tets for a method that draws tets, none: it draws all; "
                       "without it cluster_ranges");
    command.add_text("--color-by", render.color_by, "FIELD",
                     "Colour by this point or cell field; without it each isovalue has its colour");
    command.add_choice<ColorMap>("--colormap", render.scale.map,
                                 {{"viridis", ColorMap::viridis},
                                  {"cividis", ColorMap::cividis},
                                  {"plasma", ColorMap::plasma},
                                  {"turbo", ColorMap::turbo},
                                  {"cool-warm", ColorMap::cool_warm}},
                                 "Colour map; without it viridis");
    const Option range = command.add_numbers(
        "--range", render.range, "A,B",
        "Values at the ends of the colour map; without it the smallest and the largest of the field");
    const Option logarithmic =
        command.add_flag("--log", render.scale.logarithmic, "Colours follow the logarithm of the values");
    for (const Option& option : {range, logarithmic}) option.needs(command.option("--color-by"));
    add_color(command, "--no-data", render.scale.no_data, "Colour where the field has no value; without it gray");
    const Option reference = command.add_file(
        "--reference", render.reference, "FILE",
        "Compare with this picture (.png); exit status 1 when more pixels differ than --threshold allows");
    reference.excludes(sweep).excludes(orbit);
    command
        .add_number(
            "--threshold",
            [&](double share) {
                if (share < 0 || share > 1)
                    refuse_value("--threshold", shortest(share), "a share of the pixels, from 0 to 1");
                render.threshold = share;
            },
            "SHARE", "Share of the pixels that may differ visibly from --reference; without it 0.001")
        .needs(reference);
    command.add_flag("--plain", render.plain, "No text: neither scale nor legend nor caption");
    add_color(command, "--background", render.picture.background,
              "Background: white, black, gray, red, green, blue, transparent, or #rrggbb; without it white");
    command.set_details(render_details);
    return command;
}

} // namespace isotet::cli
