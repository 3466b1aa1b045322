// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <sys/mman.h>
#include <unistd.h>

#include <fmt/core.h>

#include "io/vtk/child_process.hpp"
#include "io/own/file_kind.hpp"
#include "io/own/escape.hpp"
#include "io/vtk/find_reader.hpp"
#include "io/vtk/reader_process.hpp"

namespace isotet::io::vtk {
namespace {

std::atomic<bool> can_be_reader = false;

/// The program itself where it can serve: it is sure to be of the same version. Else an installed one.
Result<std::string> reader_program(const ReadOptions& options) {
    if (!options.reader_program.empty()) return options.reader_program;
    if (can_be_reader) return std::string("/proc/self/exe");
    return find_reader(reader_places());
}

Result<Descriptor> memory_file(const char* name, std::string_view content) {
    Descriptor file(::memfd_create(name, MFD_CLOEXEC | MFD_ALLOW_SEALING));
    const bool written =
        file && ::pwrite(file.number(), content.data(), content.size(), 0) == static_cast<ssize_t>(content.size());
    if (!written)
        return Error{ErrorCode::system, fmt::format("no memory file for a reader process: {}", std::strerror(errno))};
    return file;
}

std::string reader_of(const Request& request) { return "the reader of " + request.format; }

/// Why there is no reply.
Error failure(const Request& request, const ChildOutcome& outcome) {
    const std::string path = escaped(request.path);
    const std::string said = outcome.last_output.empty() ? "" : fmt::format("; it last said: {}", outcome.last_output);
    const auto sentence = [&](ErrorCode code, std::string_view what) {
        return Error{code, fmt::format("{}: {} {}{}", path, reader_of(request), what, said)};
    };
    if (outcome.end == ChildOutcome::End::cancelled) return {ErrorCode::cancelled, path + ": reading was cancelled"};
    if (outcome.end == ChildOutcome::End::timed_out)
        return sentence(ErrorCode::system,
                        fmt::format("was stopped after {} s, its time limit", request.options.time_limit.count()));
    if (outcome.memory_ran_out)
        return sentence(ErrorCode::out_of_memory,
                        request.options.memory_limit != 0
                            ? fmt::format("needs more than its memory limit of {} bytes", request.options.memory_limit)
                            : std::string("needs more memory than is free"));
    if (outcome.end == ChildOutcome::End::killed)
        return sentence(ErrorCode::invalid_data, fmt::format("was killed by signal {} ({}): the file is broken",
                                                             outcome.number, ::strsignal(outcome.number)));
    if (outcome.end == ChildOutcome::End::not_known)
        return sentence(ErrorCode::invalid_data, "ended without a complete reply (how is not known, since this program "
                                                 "ignores SIGCHLD or waits for all its children): the file is broken");
    if (outcome.number != 0)
        return sentence(ErrorCode::invalid_data,
                        fmt::format("ended by itself with status {}: the file is broken", outcome.number));
    return sentence(ErrorCode::internal, "ended without a complete reply");
}

} // namespace

void this_program_can_be_reader() { can_be_reader = true; }

Result<Reply> ask_reader_process(Request request, const Progress& progress) {
    std::error_code no_error;
    const auto absolute = std::filesystem::absolute(request.path, no_error);
    if (!no_error) request.path = absolute.string();

    auto question = memory_file("isotet-request", encode(request));
    if (!question) return question.error();
    auto answer = memory_file("isotet-reply", "");
    if (!answer) return answer.error();

    auto program = reader_program(request.options);
    if (!program) return program.error();
    ChildRun run{*std::move(program), question->number(), answer->number(), {}};
    run.time_limit = std::clamp(request.options.time_limit, std::chrono::seconds(0), std::chrono::seconds(365 * 86400));
    auto outcome = run_child(run, progress);
    if (!outcome) return outcome.error();
    const bool may_have_replied = outcome->end == ChildOutcome::End::not_known ||
                                  (outcome->end == ChildOutcome::End::exited && outcome->number == 0);
    if (!may_have_replied) return failure(request, *outcome);

    auto reply = map_reply(answer->number());
    if (!reply) return reply.error().code == ErrorCode::internal ? failure(request, *outcome) : reply.error();
    if (auto* error = std::get_if<Error>(&*reply)) return std::move(*error);
    return reply;
}

} // namespace isotet::io::vtk
