// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What the command line asks for, one struct a command. command_options.cpp says how it is written.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <isotet/jobs/check_files.hpp>
#include <isotet/jobs/clip_files.hpp>
#include <isotet/jobs/draw_files.hpp>
#include <isotet/jobs/extract_files.hpp>
#include <isotet/jobs/look_into.hpp>
#include <isotet/paper/measure_methods.hpp>
#include <isotet/jobs/pack_file.hpp>
#include <isotet/jobs/slice_files.hpp>
#include <isotet/make.hpp>

#include "options/command_text.hpp"
#include "view/export/export_page.hpp"

namespace isotet::cli {

using namespace jobs; // what commands are made of

/// Every command has these.
struct CommonOptions {
    bool quiet = false;
    bool verbose = false;
    std::string json; ///< a file, "-" for standard output, empty for none
    int threads = 0;  ///< 0: all
};

struct InfoCommand : InfoJob {
    CommonOptions common;
};

/// How curved cells are refined; nothing: at their nodes only.
using RefineChoice = std::optional<RefineOptions>;

struct ExtractCommand : ExtractJob {
    CommonOptions common;
};

struct SliceCommand : SliceJob {
    CommonOptions common;
};

struct ClipCommand : ClipJob {
    CommonOptions common;
    bool no_polyhedra = false;
};

struct RenderCommand : DrawJob {
    CommonOptions common;
};

struct ViewCommand {
    std::optional<double> decimal_comma; ///< what two isovalues mean if their comma is a decimal sign
    CommonOptions common;
    GridOptions grid;
    FieldChoice field;
    RefineChoice refine = RefineOptions{};
    std::vector<double> isovalues;     ///< none: the page chooses one
    std::vector<IsovalueShare> shares; ///< more, of the first step
    std::string color_by;              ///< a field; empty: each isovalue has its colour
    std::string beside;                ///< a second file, read as the first; empty: none
    std::uint64_t port = 0;            ///< 0: a free one
    std::vector<std::string> hosts;    ///< names beside localhost by which a browser reaches the page
    std::uint64_t pages = 4;           ///< that may be open at once
    std::optional<std::uint64_t>
        memory; ///< of a packed file, as PackedFileOptions::memory; nothing: half of what is free
    bool keep = false;
    bool no_browser = false;
    std::string out;    ///< a folder where the page may save files; empty: none
    std::string listen; ///< an address to serve at, or a path of a Unix socket; empty: 127.0.0.1
};

struct ExportCommand : view::ExportJob {
    CommonOptions common;
};

struct PageCommand {
    CommonOptions common;
    std::string out; ///< .html
};

struct BenchCommand : BenchJob {
    CommonOptions common;
};

struct CheckCommand : CheckJob {
    CommonOptions common;
};

struct PackCommand : PackJob {
    CommonOptions common;
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

/// The hidden command `docs`.
struct DocsCommand {
    std::string kind, topic; ///< of man: the command, or empty
};

/// A whole command line. `command` says which of the structs counts.
struct CommandLine {
    std::string command;                   ///< its word, such as "extract"; empty for none
    std::vector<std::string> number_files; ///< of lists, such as -i @FILE
    std::optional<Help> help;
    bool version = false;
    InfoCommand info;
    ExtractCommand extract;
    SliceCommand slice;
    ClipCommand clip;
    RenderCommand render;
    ViewCommand view;
    ExportCommand exported;
    PageCommand page;
    BenchCommand bench;
    CheckCommand check;
    PackCommand pack;
    MakeCommand make;
    FormatsCommand formats;
    DevicesCommand devices;
    HelpCommand topic;
    DocsCommand docs;
};

} // namespace isotet::cli
