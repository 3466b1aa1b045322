// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "program.hpp"

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

#include "commands.hpp"
#include "console.hpp"
#include "option_tree.hpp"
#include "option_walker.hpp"
#include "signals.hpp"
#include "standard_streams.hpp"

namespace isotet::cli {

namespace {

bool is_command(const CLI::App& program, const std::string& word) {
    const auto commands = program.get_subcommands([&](const CLI::App* command) { return command->get_name() == word; });
    return !commands.empty();
}

/// True for a word that is more likely a mistyped command than a file: short, plain, and no file is called so.
bool looks_like_command(const std::string& word) {
    return !word.empty() && word.size() < 20 &&
           word.find_first_not_of("abcdefghijklmnopqrstuvwxyz-") == std::string::npos && word.front() != '-' &&
           !std::filesystem::exists(std::filesystem::path(word));
}

/// `isotet FILE` is short for `isotet info FILE`.
Result<void> complete_bare_file(std::vector<std::string>& words, const CLI::App& program) {
    if (words.size() < 2 || is_command(program, words[1])) return {};
    for (const char* own : {"-h", "--help", "--version"}) {
        if (words[1] == own) return {};
    }
    if (looks_like_command(words[1])) {
        return Error{ErrorCode::invalid_argument,
                     fmt::format("'{}' is neither a command nor a file; commands are info, extract, render, bench, "
                                 "check, make, formats and devices",
                                 words[1])};
    }
    words.insert(words.begin() + 1, "info");
    return {};
}

Result<ExitCode> say(const std::string& text) {
    if (Result<void> written = write_to_stdout(text); !written) return written.error();
    return ExitCode::done;
}

Result<ExitCode> help(const CLI::App& program) {
    const std::vector<CLI::App*> parsed = program.get_subcommands();
    return say(help_text(describe(parsed.empty() ? program : *parsed.back()), walk(program)));
}

Result<ExitCode> run_command(const CommandLine& line, const CLI::App& program) {
    if (line.command == "info") return run_info(line.info);
    if (line.command == "extract") return run_extract(line.extract);
    if (line.command == "render") return run_render(line.render);
    if (line.command == "bench") return run_bench(line.bench);
    if (line.command == "check") return run_check(line.check);
    if (line.command == "make") return run_make(line.make);
    if (line.command == "formats") return run_formats(line.formats);
    if (line.command == "devices") return run_devices(line.devices);
    if (line.command == "docs") return run_docs(line.docs, program);
    if (line.version) return say(version_text());
    return Error{ErrorCode::invalid_argument, "no command and no file was given; isotet --help lists the commands"};
}

Result<ExitCode> parse_and_run(std::vector<std::string> words) {
    CommandLine line;
    const std::unique_ptr<CLI::App> program = make_option_tree(line);
    if (Result<void> completed = complete_bare_file(words, *program); !completed) return completed.error();
    try {
        std::vector<std::string> backwards(words.rbegin(), words.rend() - (words.empty() ? 0 : 1));
        program->parse(backwards); // CLI11 takes the words from the back
    } catch (const CLI::CallForHelp&) {
        return help(*program);
    } catch (const CLI::ParseError& error) {
        const std::vector<CLI::App*> parsed = program->get_subcommands();
        const std::string where = parsed.empty() ? "isotet" : "isotet " + parsed.back()->get_name();
        return Error{ErrorCode::invalid_argument, fmt::format("{} ({} --help lists the options)", error.what(), where)};
    }
    return run_command(line, *program);
}

} // namespace

ExitCode run_program(std::vector<std::string> words) {
    const Result<ExitCode> result = parse_and_run(std::move(words));
    if (result) return *result;
    // Whatever an operation said when it was stopped half-way, it was Ctrl-C that stopped it.
    if (interrupted || result.error().code == ErrorCode::cancelled) {
        say_error("interrupted: no file was left half written");
        return ExitCode::interrupted;
    }
    say_error(result.error().message);
    return exit_code_of(result.error().code);
}

} // namespace isotet::cli
