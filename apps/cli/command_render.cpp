// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// `isotet render`: pictures of isosurfaces, or of a surface.
#include <isotet/jobs/draw_files.hpp>

#include "commands.hpp"
#include "output/console.hpp"
#include "output/render_report.hpp"

namespace isotet::cli {

Result<ExitCode> run_render(const RenderCommand& command) {
    Console console(command.common);
    DrawJob job = command;
    job.other_outputs = {command.common.json};
    const Result<DrawReport> done = draw_files(job, console);
    if (!done) return done.error();
    return finish(console, command.common, render_table(job, *done), render_json(job, *done),
                  done->pictures.differs.value_or(0) > job.threshold ? ExitCode::check_failed : ExitCode::done);
}

} // namespace isotet::cli
