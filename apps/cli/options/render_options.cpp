// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <isotet/jobs/number_text.hpp>
#include <isotet/scene.hpp>

#include "options/command_options.hpp"
#include "options/shape_text.hpp"

namespace isotet::cli {

namespace {

constexpr const char* render_details = R"(
With nothing but FILE it draws what isotet info says is shown first: isosurfaces at three isovalues inside the field's
range, each in its own colour; or the boundary, coloured. FIELD is found as by isotet extract.

OUT ends in .png; without it the picture gets FILE's name, in the current folder. The pictures of --sweep and --orbit
are numbered from 1 where {frame} stands in OUT, or go into one animated file when OUT ends in .webp.

The CPU draws, with the same bytes on every machine, unless --device or --engine vulkan asks for a Vulkan device; a
method that draws tets needs one.

Examples:
  isotet render grid.vtu
  isotet render grid.vtu pressure.png -f pressure -i 0.5
  isotet render surface.vtp --view +x --size 800x600 --background transparent
  isotet render grid.vtu -f pressure --sweep 0,1,50 -o sweep.webp
  isotet render grid.vtu -f pressure -i 0.5 --orbit 90 -o 'frame{frame}.png'
  isotet render grid.vtu -f pressure --slice x=0 --clip x=0 --view 30,20
  isotet render model.vtu --boundary-color-by region --edges --scale 1,1,20
  isotet render grid.vtu -f pressure --volume --opacity 0:0,0.4:0.1,0.5:0.8
  isotet render grid.vtu -f pressure --volume --opacity peaks:2 -i 0.5 --orbit 60 -o film.webp
)";

void add_size(const Command& command, PictureOptions& picture) {
    const OptionGroup group(command, "Picture and camera");
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
        "WxH", "Width and height of the picture in pixels; default: 1200x900");
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

/// How dark folds become.
void add_occlusion(const Command& command, RenderCommand& render) {
    const OptionGroup group(command, "Opacity and light");
    command.add_number(
        "--occlusion",
        [&render](double number) {
            if (number < 0 || number > 1) refuse_value("--occlusion", shortest(number), "a number from 0 to 1");
            render.occlusion = number;
        },
        "PART", "How dark folds and hollows of opaque surfaces become, 0 to 1; default: 0.8. On a device: 0");
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

/// "z", "+z" and "-z".
std::optional<UpAxis> parse_up_axis(std::string_view text) {
    const bool minus = text.starts_with('-');
    if (minus || text.starts_with('+')) text.remove_prefix(1);
    if (text.size() != 1 || text[0] < 'x' || text[0] > 'z') return {};
    return static_cast<UpAxis>(2 * (text[0] - 'x') + (minus ? 1 : 0));
}

void add_camera(const Command& command, RenderCommand& render) {
    const OptionGroup group(command, "Picture and camera");
    command.add_value(
        "--view",
        [&render](const std::string& text) {
            const std::optional<View> named = parse_view(text);
            const std::vector<double> angles = parse_numbers(text);
            if (!named && (angles.size() != 2 || std::abs(angles[1]) > 90))
                refuse_value("--view", text,
                             "iso, +x, -x, +y, -y, +z, -z, or AZIMUTH,ELEVATION in degrees, such as 30,20");
            if (named) render.view = *named;
            render.angles = named ? std::vector<double>() : angles;
        },
        "VIEW",
        "From where one looks: iso, +x, -x, +y, -y, +z, -z, or AZIMUTH,ELEVATION, degrees to the right of the front "
        "and "
        "upwards; default: iso, and along the thin axis of flat grids without isosurfaces");
    command.add_value(
        "--up",
        [&render](const std::string& text) {
            render.up = parse_up_axis(text);
            if (!render.up) refuse_value("--up", text, "x, y or z, with a minus where it points downwards");
        },
        "AXIS", "The axis that points upwards; default: z");
    command.add_number(
        "--zoom",
        [&render](double factor) {
            if (factor <= 0) refuse_value("--zoom", shortest(factor), "a number above 0");
            render.zoom = factor;
        },
        "FACTOR", "Magnification");
    command.add_choice<bool>("--fit", render.fit_surface, {{"grid", false}, {"surface", true}},
                             "What fills the picture: the grid, or isosurfaces and slices alone; default: grid");
    command.add_value(
        "--camera",
        [&render](const std::string& text) {
            render.camera = parse_camera(text);
            if (!render.camera)
                refuse_value("--camera", text,
                             "perspective:TARGET:DIRECTION:UP:DISTANCE:ANGLE or parallel:TARGET:DIRECTION:UP:HEIGHT, "
                             "as --json tells");
        },
        "CAMERA", "The camera of another picture, as -v and --json print it");
    command.add_flag("--parallel", render.parallel, "Parallel projection, without perspective");
    command.add_flag("--scale-bar", render.scale_bar, "Draw a scale bar; with --parallel there always is one");
    command.add_text("--unit", render.unit, "TEXT", "Unit of coordinates, written beside the scale bar");
    command.add_value(
        "--scale",
        [&render](const std::string& text) {
            render.stretch = parse_numbers(text);
            const bool positive = std::ranges::all_of(render.stretch, [](double factor) { return factor > 0; });
            if (render.stretch.size() != 3 || !positive)
                refuse_value("--scale", text, "three numbers above 0, of x, y and z, such as 1,1,20");
        },
        "X,Y,Z",
        "Stretch the axes by these factors; 1,1,20 exaggerates heights; default: 1,1,1, and larger heights for "
        "corner-point grids at least 50 times as wide as high");
}

void add_cuts(const Command& command, RenderCommand& render) {
    const OptionGroup group(command, "Cuts, cells, shading");
    const auto add_planes = [&command](const std::string& name, std::vector<Plane>& planes, const std::string& text) {
        command.add_texts(
            name,
            [&planes, name](const std::vector<std::string>& texts) {
                for (const std::string& one : texts) {
                    const std::optional<Plane> plane = parse_plane(one);
                    if (!plane) refuse_value(name, one, "x=0.5, -x=0.5 (y and z alike), or NX,NY,NZ,OFFSET");
                    planes.push_back(*plane);
                }
            },
            "PLANE", text);
    };
    add_planes("--clip", render.clips,
               "Leave out what is beyond a plane: x=0.5 larger x, -x=0.5 smaller x, NX,NY,NZ,OFFSET where the product "
               "with the normal is larger; may be repeated");
    add_planes("--slice", render.slices,
               "Show the cut through the grid along a plane, coloured by --color-by or else by the field; isosurfaces "
               "only with -i, --levels or --sweep; may be repeated");
    command.add_choice<std::optional<SolidSide>>(
        "--solid", render.solid, {{"above", SolidSide::above}, {"below", SolidSide::below}},
        "Closed solids in place of isosurfaces: the grid where the field is at least the isovalue, or below it");
    command.add_value(
        "--keep", [&render](const std::string& text) { render.keep = parse_parts(text); },
        "largest|N|area>A|volume>V|touching:boundary|parts:I[,J]|not:I[,J]",
        "Only these connected parts of each isosurface or solid, as isotet extract");
    command.add_flag(
        "--edges", render.edges,
        "Draw the edges of the triangles of boundary and slices, or of the surfaces where neither is drawn");
    command.add_flag("--split-cells", render.contour.split_cells,
                     "Split pyramids, wedges and hexahedra into tets first: 2 to 3 times the triangles");
    add_refinement(command, render.contour.refine, &render.refine_averaged);
    command.add_text("--boundary-color-by", render.boundary_color_by, "FIELD",
                     "Colour the grid's boundary by this field, opaque unless --boundary says otherwise; isosurfaces "
                     "only with -f, -i, --levels or --sweep");
    command.add_choice<ShadeBy>(
        "--normals", render.shade_by,
        {{"vertex", ShadeBy::vertices}, {"gradient", ShadeBy::gradient}, {"face", ShadeBy::faces}},
        "Shade by the mean of the faces around each vertex, by the gradient of the field, or "
        "each triangle flat; default: vertex");
}

/// A number is the opacity of surfaces, all else that of a volume.
void set_opacity(const Command& command, RenderCommand& render, const std::string& text) {
    if (text.starts_with('@')) {
        const Command::NamedText file = command.text_of_file(text);
        Result<OpacityText> parsed = parse_opacity_file(file.text, file.name);
        if (!parsed) refuse_file(ErrorCode::invalid_data, file.file + ": " + parsed.error().message);
        render.volume_opacity = *std::move(parsed);
        return;
    }
    const std::vector<double> numbers = parse_numbers(text);
    if (numbers.size() == 1) {
        if (numbers[0] < 0 || numbers[0] > 1) refuse_value("--opacity", text, "a number from 0 to 1");
        render.opacity = numbers[0];
        return;
    }
    Result<OpacityText> parsed = parse_opacity(text);
    if (!parsed)
        refuse_value("--opacity", text, "a number from 0 to 1, or opacity by values: " + parsed.error().message);
    render.volume_opacity = *std::move(parsed);
}

void add_opacity(const Command& command, RenderCommand& render) {
    const OptionGroup group(command, "Opacity and light");
    command.add_texts(
        "--opacity",
        [&render, command](const std::vector<std::string>& texts) {
            for (const std::string& text : texts) set_opacity(command, render, text);
        },
        "OPACITY",
        "Opacity of the surfaces, 0 to 1; default: 1, and 0.35 for isosurfaces that hide others. "
        "Of a volume: VALUE:OPACITY,... ascending, with lines between; ramp (default); peaks or peaks:N, at N values; "
        "shell, transparent near the ends of the range; or @FILE[:NAME], with such points, or a colour map of ParaView "
        "in JSON with its opacity over values as they are. May be given for both");
    command.add_flag(
        "--volume", render.volume,
        "Draw the field as a volume; isosurfaces only with -i or --levels, the boundary only with --boundary. "
        "--sweep moves a peak of opacity through it");
    command.add_number(
        "--opacity-length",
        [&render](double length) {
            if (length <= 0) refuse_value("--opacity-length", shortest(length), "a number above 0");
            render.opacity_length = length;
        },
        "LENGTH",
        "Length over which one value of a volume has its opacity; default: a tenth of the diagonal of the grid's box");
    command.add_flag("--volume-shading", render.volume_shading,
                     "Light the colours of a volume as those of isosurfaces, by the gradient of the field in each tet");
    command.add_numbers(
        "--dirac", render.dirac, "V[,W...]",
        "Draw isosurfaces, at numbers or shares such as 50%v or p95, by rays through the volume, opaque, "
        "without extracting them; its opacity is only drawn where --opacity is given",
        {[&render](std::string_view word) {
             const std::optional<IsovalueShare> share = parse_share(word);
             if (share) render.dirac_shares.push_back(*share);
             return share.has_value();
         },
         "finite numbers, or shares such as 90%v or p95",
         {}});
}

/// Of the first two numbers each may be a share.
Option add_sweep(const Command& command, RenderCommand& render) {
    return command.add_numbers(
        "--sweep", render.sweep, "A,B,N",
        "N pictures, at isovalues from A to B: numbers, or shares such as 5%v or p95 (of the first step)",
        shares_of_ends(render.sweep, render.sweep_shares,
                       "finite numbers, of which the first two may be shares such as 90%v or p95"));
}

} // namespace

Command add_render_command(const Command& program, RenderCommand& render) {
    const Command command = program.add_command("render", "Draw isosurfaces, or a surface, into a picture");
    command.add_file("FILE", render.grid.file, "FILE", "A grid or a surface: a file, or make:SHAPE:SIDE[:FIELDS]")
        .required();
    command.add_file("-o,--output", render.out, "OUT_FILE", "The picture, .png; many: {frame} in the name, or .webp");
    add_out_and_more_files(command, render.grid, render.out, "The picture, as -o");
    add_field(command, render.field,
              "The field to contour, or an expression such as mag(U); default: the one that info says is shown first");
    add_centre(command, render.field);
    const Option isovalues = add_isovalues(command, render.isovalues, render.shares, &render.decimal_comma);
    command.add_flag("--allow-empty", render.allow_empty,
                     "Draw also where all isovalues are outside the range of the field, which else is an error");
    command
        .add_count(
            "--levels", {1, 100}, [&](std::uint64_t n) { render.levels = n; }, "N",
            "N isovalues evenly inside the range of the field without its rare values, the same at all time steps; "
            "default: 3 at "
            "round numbers")
        .excludes(isovalues);
    const Option sweep = add_sweep(command, render).excludes(isovalues);
    sweep.excludes(command.option("--levels"));
    const Option orbit = command.add_count(
        "--orbit", {2, 100'000}, [&](std::uint64_t n) { render.orbit = n; }, "N",
        "N pictures, once around the grid from left to right");
    orbit.excludes(sweep);
    command.add_number(
        "--fps",
        [&](double rate) {
            if (rate <= 0 || rate > 100)
                refuse_value("--fps", shortest(rate), "pictures a second, above 0 and up to 100");
            render.frames_per_second = rate;
        },
        "RATE", "Pictures a second of an animated OUT; default: 12");
    add_part(command, "--boundary", render.boundary, "Opacity of the grid's boundary, 0 to 1; default: 0.1");
    command.add_flag("--outline", render.outline, "Draw the edges of the grid's box");
    add_opacity(command, render);
    add_occlusion(command, render);
    add_size(command, render.picture);
    add_camera(command, render);
    add_cuts(command, render);
    command.add_choice<EngineChoice>(
        "--engine", render.engine,
        {{"auto", EngineChoice::automatic}, {"cpu", EngineChoice::cpu}, {"vulkan", EngineChoice::vulkan}},
        "What extracts: auto is the device that draws if it is a graphics card, so that surfaces stay there, else the "
        "CPU; vulkan draws, too");
    std::vector<std::pair<std::string, DrawHow>> methods{
        {"auto", {}}, {"direct", {Method::direct, {}}}, {"clusters", {Method::clusters, {}}}};
    for (const DrawMethod method : all_draw_methods) methods.push_back({std::string(name_of(method)), {{}, method}});
    command.add_choice("--method", render.method, methods,
                       "auto, direct and clusters extract surfaces, as isotet extract does; the others are earlier "
                       "methods that draw tets and make no surface; default: auto");
    std::vector<std::pair<std::string, std::optional<SearchIndex>>> indexes;
    for (const SearchIndex index : all_search_indexes) indexes.emplace_back(name_of(index), index);
    command.add_choice("--index", render.index, indexes,
                       "Search index that finds the active tets for a method that draws tets; none: it draws all; "
                       "default: cluster_ranges");
    command.add_text("--color-by", render.color_by, "FIELD",
                     "Colour by this point or cell field; default: each isovalue has its colour");
    add_color_scale(command, render.scale, render.range);
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
            "SHARE", "Share of the pixels that may differ visibly from --reference; default: 0.001")
        .needs(reference);
    command.add_flag("--plain", render.plain, "No text: neither scale nor legend nor caption");
    add_color(command, "--background", render.picture.background,
              "Background: white, black, gray, red, green, blue, transparent, or #rrggbb; default: white");
    command.set_details(render_details);
    return command;
}

void add_color_scale(const Command& command, ColorScale& scale, std::vector<double>& range) {
    const OptionGroup group(command, "Colours");
    command.add_choice_or_file<ColorMap>(
        "--colormap", scale.map,
        {{"viridis", ColorMap::viridis},
         {"cividis", ColorMap::cividis},
         {"plasma", ColorMap::plasma},
         {"turbo", ColorMap::turbo},
         {"cool-warm", ColorMap::cool_warm}},
        [&scale](const Command::NamedText& file) {
            Result<ColorMapFile> map = parse_color_map_file(file.text, file.name);
            if (!map) refuse_file(ErrorCode::invalid_data, file.file + ": " + map.error().message);
            if (map->colors.empty())
                refuse_file(ErrorCode::invalid_data,
                            fmt::format("{}: its colour map '{}' has no RGBPoints", file.file, map->name));
            scale.colors = std::move(map->colors);
            if (map->no_data) scale.no_data = *map->no_data;
        },
        "Colour map, or one of ParaView in JSON, from end to end of --range; default: viridis");
    command.add_numbers("--range", range, "A,B",
                        "Values at the ends of the colour map; default: the smallest and the largest of the field");
    command.add_flag("--log", scale.logarithmic, "Colours follow the logarithm of the values");
    add_color(command, "--no-data", scale.no_data, "Colour where the field has no value; default: gray");
}

} // namespace isotet::cli
