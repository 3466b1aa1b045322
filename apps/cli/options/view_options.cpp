// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "options/command_options.hpp"

namespace isotet::cli {

namespace {

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

} // namespace

void add_view_command(const Command& program, ViewCommand& view) {
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

} // namespace isotet::cli
