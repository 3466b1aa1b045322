// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "program.hpp"

#include <filesystem>

#include <fmt/format.h>

#include "options/command_text.hpp"
#include "commands.hpp"
#include "output/console.hpp"
#include "options/option_tree.hpp"
#include "options/options.hpp"
#include "output/signals.hpp"
#include "output/standard_streams.hpp"

namespace isotet::cli {

namespace {

/// True for a word that is more likely a mistyped command than a file: short, plain, and no file is called so.
bool looks_like_command(const std::string& word) {
    return !word.empty() && word.size() < 20 &&
           word.find_first_not_of("abcdefghijklmnopqrstuvwxyz-") == std::string::npos && word.front() != '-' &&
           !std::filesystem::exists(std::filesystem::path(word));
}

/// `isotet FILE` is short for `isotet info FILE`.
Result<void> complete_bare_file(std::vector<std::string>& words, const OptionTree& tree) {
    if (words.size() < 2 || tree.has_command(words[1])) return {};
    for (const char* own : {"-h", "--help", "--help-all", "--version"}) {
        if (words[1] == own) return {};
    }
    if (looks_like_command(words[1])) {
        return usage_error("'{}' is neither a command nor a file; commands are {}", words[1],
                           fmt::join(tree.words(), ", "));
    }
    words.insert(words.begin() + 1, "info");
    return {};
}

Result<ExitCode> say(const std::string& text) {
    if (Result<void> written = write_to_stdout(text); !written) return written.error();
    return ExitCode::done;
}

Result<ExitCode> run_words(std::vector<std::string> words) {
    CommandLine line;
    OptionTree tree(line);
    if (Result<void> completed = complete_bare_file(words, tree); !completed) return completed.error();
    if (Result<void> parsed = tree.parse(words); !parsed) return parsed.error();
    for (GridOptions* grid : {&line.info.grid, &line.extract.grid, &line.slice.grid, &line.clip.grid, &line.render.grid,
                              &line.view.grid, &line.exported.grid, &line.bench.grid, &line.pack.grid})
        grid->other_inputs = line.number_files;
    if (line.help) return say(help_text(tree.describe(line.command), tree.describe_all(), *line.help));
    if (line.command == "info") return run_info(line.info);
    if (line.command == "extract") return run_extract(line.extract);
    if (line.command == "slice") return run_slice(line.slice);
    if (line.command == "clip") return run_clip(line.clip);
    if (line.command == "render") return run_render(line.render);
    if (line.command == "view") return run_view(line.view);
    if (line.command == "export") return run_export(line.exported);
    if (line.command == "page") return run_page(line.page);
    if (line.command == "bench") return run_bench(line.bench);
    if (line.command == "check") return run_check(line.check);
    if (line.command == "pack") return run_pack(line.pack);
    if (line.command == "make") return run_make(line.make);
    if (line.command == "formats") return run_formats(line.formats);
    if (line.command == "devices") return run_devices(line.devices);
    if (line.command == "help") {
        if (line.topic.topic.empty() || tree.has_command(line.topic.topic))
            return say(help_text(tree.describe(line.topic.topic), tree.describe_all(), Help::common));
        return usage_error("'{}' is no command; commands are {}", line.topic.topic, fmt::join(tree.words(), ", "));
    }
    if (line.command == "docs") return run_docs(line.docs, tree.describe_all());
    if (line.version) return say(version_text());
    return usage_error("no command and no file was given; isotet --help lists the commands");
}

} // namespace

ExitCode run_program(std::vector<std::string> words) {
    const Result<ExitCode> result = run_words(std::move(words));
    if (result) return *result;
    // Whatever error an operation returned when it was stopped, Ctrl-C was the cause.
    if (stop_requested || result.error().code == ErrorCode::cancelled) {
        take_time_to_stop(); // what is told is not told again
        write_to_stderr(interrupted_sentence);
        return ExitCode::interrupted;
    }
    say_error(result.error().message);
    return exit_code_of(result.error().code);
}

} // namespace isotet::cli
