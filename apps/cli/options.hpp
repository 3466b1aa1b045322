// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What the command line asks for, one struct a command. command_options.cpp says how it is written.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <isotet/draw_tets.hpp>
#include <isotet/extract.hpp>
#include <isotet/grid_bench.hpp>
#include <isotet/isosurface_scene.hpp>
#include <isotet/make.hpp>
#include <isotet/pack.hpp>
#include <isotet/pieces.hpp>
#include <isotet/plan.hpp>
#include <isotet/refine.hpp>
#include <isotet/render.hpp>
#include <isotet/search.hpp>
#include <isotet/write.hpp>

namespace isotet::cli {

/// Every command has these.
struct CommonOptions {
    bool quiet = false;
    bool verbose = false;
    std::string json; ///< a file, "-" for standard output, empty for none
    int threads = 0;  ///< 0: all
};

/// Which grid, and how it is read.
struct GridOptions {
    std::string file; ///< or "make:SHAPE:SIDE[:FIELDS]"
    std::string format;
    std::optional<double> time;
    std::optional<std::uint64_t> step;
    std::optional<double> merge_points; ///< tolerance
    MergedValues merge_values = MergedValues::lowest;
    bool keep_pieces = false;
    bool allow_outside = false;
    std::string displace;
    std::vector<std::string> blocks; ///< names or numbers; empty: all
};

/// A field's name, and what it is when a point field and a cell field have it.
struct FieldChoice {
    std::string name; ///< empty: the only one there is
    bool cell_field = false;
};

struct InfoCommand {
    CommonOptions common;
    GridOptions grid;
    bool survey = false;                ///< also what takes longer than reading
    FieldChoice field;                  ///< of the chart; empty: the one that varies most
    std::optional<std::uint64_t> chart; ///< steps; nothing: no chart
};

enum class EngineChoice : std::uint8_t { automatic, cpu, vulkan, reference };

/// Which Vulkan device, and how much of its memory.
struct DeviceChoice {
    std::string name;                    ///< as DeviceOptions::choice; "none": no device
    std::optional<std::uint64_t> memory; ///< bytes at most
};

/// How quadratic cells are refined; nothing: at their nodes only.
using RefineChoice = std::optional<RefineOptions>;

struct ExtractCommand {
    CommonOptions common;
    GridOptions grid;
    bool all_steps = false;
    std::string out; ///< empty: only numbers
    FieldChoice field;
    std::vector<double> isovalues;
    std::uint64_t levels = 0; ///< 0: `isovalues` say it
    bool snap = false;
    Normals normals = Normals::none;
    std::optional<std::vector<std::string>> with; ///< nothing: all point fields that the format can hold
    bool keep_degenerate = false;
    bool fail_if_empty = false;
    bool edge_ends = false;
    bool source_cells = false;
    bool split_cells = false;
    bool exact_vertices = false;
    Precision precision = Precision::float32;
    std::optional<Method> method; ///< nothing: by the rule
    EngineChoice engine = EngineChoice::automatic;
    DeviceChoice device; ///< `name` is empty without --device
    std::optional<PieceOf> piece;
    Compression compression = Compression::none;
    RefineChoice refine = RefineOptions{};
};

/// The opacity of the grid's boundary where none is given.
constexpr double default_boundary_opacity = 0.1;

/// What finds tets for a method that draws tets, where no search index is given.
constexpr SearchIndex default_index = SearchIndex::cluster_ranges;

/// Isovalues where neither -i nor --levels is given.
constexpr std::uint64_t default_levels = 3;

/// How a picture comes about: surfaces are extracted (by the rule where nothing is set), or tets are drawn.
struct RenderMethod {
    std::optional<Method> extract;
    std::optional<DrawMethod> draw; ///< draws tets, and no surface is made
};

struct RenderCommand {
    CommonOptions common;
    GridOptions grid; ///< `file` may be a surface
    std::string out;  ///< empty: called as FILE is
    FieldChoice field;
    std::vector<double> isovalues;
    std::uint64_t levels = 0; ///< 0: `isovalues` say it, or three
    PictureOptions picture;   ///< the camera aside
    View view = View::iso;
    std::vector<double> angles; ///< azimuth and elevation, instead of `view`; or none
    std::optional<UpAxis> up;
    std::optional<Camera> camera; ///< all of it: neither view nor fit counts
    double zoom = 1;
    bool fit_surface = false; ///< else the grid
    bool parallel = false;
    std::string unit; ///< of coordinates, beside a scale bar; empty: none
    bool scale_bar = false;
    std::vector<double> stretch; ///< of x, y and z; or none
    std::vector<Plane> clips, slices;
    bool edges = false;
    bool split_cells = false;
    ShadeBy shade_by = ShadeBy::vertices;
    std::string boundary_color_by; ///< a field; empty: none
    bool all_steps = false;
    bool outline = false;                    ///< the box around
    bool plain = false;                      ///< no text
    std::string color_by;                    ///< a field; empty: each isovalue has its colour
    ColorScale scale;                        ///< the map, the logarithm and the colour for no data
    std::vector<double> range;               ///< both ends of the scale, or none
    std::optional<double> boundary, opacity; ///< of the grid's boundary, of the surfaces
    EngineChoice engine = EngineChoice::automatic;
    RenderMethod method;
    std::optional<SearchIndex> index; ///< nothing: none was given
    std::vector<double> sweep;        ///< first and last isovalue, and how many; or none
    std::uint64_t orbit = 0;          ///< pictures around; 0: one
    double frames_per_second = 12;
    std::string reference;    ///< a picture to compare with; empty: none
    double threshold = 0.001; ///< share of its pixels that may differ
    DeviceChoice device;
    RefineChoice refine = RefineOptions{};
};

struct ViewCommand {
    CommonOptions common;
    GridOptions grid;
    FieldChoice field;
    std::vector<double> isovalues;  ///< none: the page chooses one
    std::string color_by;           ///< a field; empty: each isovalue has its colour
    std::uint64_t port = 0;         ///< 0: a free one
    std::vector<std::string> hosts; ///< names beside localhost by which a browser reaches the page
    bool keep = false;
    bool no_browser = false;
    std::string out;    ///< a folder where the page may save files; empty: none
    std::string listen; ///< an address to serve at, or a path of a Unix socket; empty: 127.0.0.1
};

struct BenchCommand {
    CommonOptions common;
    GridOptions grid; ///< `file` is empty with --paper
    FieldChoice field;
    std::vector<double> isovalues; ///< none: three
    bool paper = false;
    std::uint64_t max_tets = 5'000'000;
    std::vector<BenchMethod> methods; ///< none: all that can be
    std::vector<SearchIndex> indexes; ///< none: without and with the interval tree
    std::uint64_t rounds = 5;
    DeviceChoice device;
};

struct CheckCommand {
    CommonOptions common;
    std::string surface;
    std::vector<std::string> more; ///< other pieces of the surface
    std::string format;
    bool closed = false;
    bool strict = false;
    bool split_cells = false;
    GridOptions grid; ///< `file` is empty without --grid
    FieldChoice field;
};

struct MakeCommand {
    CommonOptions common;
    MakeOptions grid;
    std::string out;
    Compression compression = Compression::none;
};

struct FormatsCommand {
    CommonOptions common;
};

struct DevicesCommand {
    CommonOptions common;
    DeviceChoice device; ///< `name` is empty without --device
};

struct HelpCommand {
    std::string topic; ///< a command; empty: the program
};

/// The hidden command `docs`: man, completion or markdown.
struct DocsCommand {
    std::string kind;
};

/// A whole command line. `command` says which of the structs counts.
struct CommandLine {
    std::string command; ///< its word, such as "extract"; empty for none
    bool help = false;
    bool version = false;
    InfoCommand info;
    ExtractCommand extract;
    RenderCommand render;
    ViewCommand view;
    BenchCommand bench;
    CheckCommand check;
    MakeCommand make;
    FormatsCommand formats;
    DevicesCommand devices;
    HelpCommand topic;
    DocsCommand docs;
};

} // namespace isotet::cli
