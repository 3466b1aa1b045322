// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// `isotet docs`: man page, completion and docs/command-line.md, for the build and for a test.
#include <fmt/format.h>

#include "command_text.hpp"
#include "commands.hpp"
#include "standard_streams.hpp"

namespace isotet::cli {

Result<ExitCode> run_docs(const DocsCommand& command, const std::vector<CommandText>& commands) {
    std::string text;
    if (command.kind == "man") text = man_page(commands);
    else if (command.kind == "completion") text = bash_completion(commands);
    else if (command.kind == "markdown") text = markdown(commands);
    else {
        return usage_error("docs got '{}', but it takes man, completion or markdown", command.kind);
    }
    if (Result<void> written = write_to_stdout(text); !written) return written.error();
    return ExitCode::done;
}

} // namespace isotet::cli
