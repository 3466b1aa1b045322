// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// `isotet docs`: man page, completion and docs/command-line.md, for the build and for a test.
#include <fmt/format.h>

#include "commands.hpp"
#include "option_walker.hpp"
#include "standard_streams.hpp"

namespace isotet::cli {

Result<ExitCode> run_docs(const DocsCommand& command, const CLI::App& program) {
    const std::vector<CommandText> commands = walk(program);
    std::string text;
    if (command.kind == "man") text = man_page(commands);
    else if (command.kind == "completion") text = bash_completion(commands);
    else if (command.kind == "markdown") text = markdown(commands);
    else {
        return Error{ErrorCode::invalid_argument,
                     fmt::format("docs got '{}', but it takes man, completion or markdown", command.kind)};
    }
    if (Result<void> written = write_to_stdout(text); !written) return written.error();
    return ExitCode::done;
}

} // namespace isotet::cli
