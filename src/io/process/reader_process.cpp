// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/process/reader_process.hpp"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <sys/mman.h>
#include <unistd.h>

#include <fmt/core.h>

#include "io/files/escape.hpp"
#include "base/system/descriptor.hpp"
#include "io/process/child_pool.hpp"
#include "io/process/find_reader.hpp"

namespace isotet::io::confined {
namespace {

namespace fs = std::filesystem;

Result<core::Descriptor> memory_file(const char* name, std::string_view content) {
    core::Descriptor file(::memfd_create(name, MFD_CLOEXEC | MFD_ALLOW_SEALING));
    const bool written =
        file && ::pwrite(file.number(), content.data(), content.size(), 0) == static_cast<ssize_t>(content.size());
    if (!written)
        return Error{ErrorCode::system, fmt::format("no memory file for a reader process: {}", std::strerror(errno))};
    return file;
}

/// The folder of the file; the file itself, too, where its name is a link to another place.
std::vector<std::string> readable_places(const Request& request) {
    if (request.options.allow_outside) return {"/"};
    std::error_code error;
    const fs::path folder = fs::path(request.path).parent_path();
    std::vector<std::string> places{fs::weakly_canonical(folder, error).string()};
    const fs::path file = fs::canonical(request.path, error);
    const fs::path inside = file.lexically_relative(places[0]);
    if (!error && (inside.empty() || *inside.begin() == "..")) places.push_back(file.string());
    return places;
}

/// Requests with the same key can be answered by one process.
std::string key_of(const Request& request, const std::string& program) {
    std::string key = fmt::format("{}\n{}", program, request.options.memory_limit);
    for (const std::string& place : request.readable) key += '\0' + place;
    return key;
}

/// Why there is no reply.
Error failure(const Request& request, const ChildOutcome& outcome) {
    const std::string said = outcome.last_output.empty() ? "" : fmt::format("; it last said: {}", outcome.last_output);
    const auto sentence = [&](ErrorCode code, std::string_view what) {
        return Error{code, fmt::format("{}: the reader of {} {}{}", escaped(request.path), request.format, what, said)};
    };
    using End = ChildOutcome::End;
    if (outcome.end == End::cancelled) return {ErrorCode::cancelled, escaped(request.path) + ": reading was cancelled"};
    if (outcome.end == End::timed_out)
        return sentence(ErrorCode::system,
                        fmt::format("was stopped after {} s, its time limit", request.options.time_limit.count()));
    if (outcome.memory_ran_out)
        return sentence(ErrorCode::out_of_memory,
                        request.options.memory_limit != 0
                            ? fmt::format("needs more than its memory limit of {} bytes", request.options.memory_limit)
                            : std::string("needs more memory than is free"));
    if (outcome.time_ran_out)
        return sentence(ErrorCode::invalid_data, "came to no end in the processor time that a file of this size may "
                                                 "take: the file is broken");
    if (outcome.file_limit)
        return sentence(
            ErrorCode::system,
            "cannot hand the grid over: it is larger than the limit on the size of files (ulimit -f) allows");
    if (outcome.end == End::killed) {
        switch (outcome.number) {
        case SIGKILL:
            return sentence(ErrorCode::out_of_memory,
                            "was killed (signal 9): by the system when memory ran out, or from outside");
        case SIGXCPU: return sentence(ErrorCode::system, "was stopped by the limit on processor time (ulimit -t)");
        case SIGTERM:
        case SIGINT:
        case SIGHUP:
            return sentence(ErrorCode::system, fmt::format("was stopped from outside (signal {}, {})", outcome.number,
                                                           ::strsignal(outcome.number)));
        case SIGBUS:
            return sentence(
                ErrorCode::invalid_data,
                "was killed by signal 7 (Bus error): the file is broken, or was cut short while it was read");
        default:
            return sentence(ErrorCode::invalid_data, fmt::format("was killed by signal {} ({}): the file is broken",
                                                                 outcome.number, ::strsignal(outcome.number)));
        }
    }
    if (outcome.end == End::not_known)
        return sentence(ErrorCode::invalid_data, "ended without a complete reply (how is not known, since this program "
                                                 "ignores SIGCHLD or waits for all its children): the file is broken");
    if (outcome.end == End::exited && outcome.number != 0)
        return sentence(ErrorCode::invalid_data,
                        fmt::format("ended by itself with status {}: the file is broken", outcome.number));
    return sentence(ErrorCode::internal, "ended without a complete reply");
}

/// One question to a process that waits, or to a new one.
Result<ChildOutcome> ask(const Request& request, int question, int answer, const std::string& program,
                         const Progress& progress) {
    const auto limit =
        std::clamp(request.options.time_limit, std::chrono::seconds(0), std::chrono::seconds(365 * 86400));
    const auto deadline = std::chrono::steady_clock::now() + limit;
    const std::string key = key_of(request, program);
    std::unique_ptr<ReaderChild> child = take_idle_child(key);
    if (child) {
        ChildOutcome outcome = child->ask(question, answer, deadline, progress);
        const bool stopped = outcome.end == ChildOutcome::End::cancelled || outcome.end == ChildOutcome::End::timed_out;
        if (child->waits()) keep_idle_child(key, std::move(child));
        if (outcome.taken || stopped) return outcome; // else it had ended before it saw the request
    }
    auto started = ReaderChild::start(program);
    if (!started) return started.error();
    ChildOutcome outcome = (*started)->ask(question, answer, deadline, progress);
    if (outcome.end == ChildOutcome::End::replied && (*started)->waits()) keep_idle_child(key, std::move(*started));
    return outcome;
}

} // namespace

Result<Reply> ask_reader_process(Request request, const Progress& progress) {
    std::error_code no_error;
    const auto absolute = fs::absolute(request.path, no_error);
    if (!no_error) request.path = absolute.string();
    request.readable = readable_places(request);

    auto question = memory_file("isotet-request", encode(request));
    if (!question) return question.error();
    auto answer = memory_file("isotet-reply", "");
    if (!answer) return answer.error();
    auto program = request.options.reader_program.empty() ? find_reader(reader_places())
                                                          : Result<std::string>(request.options.reader_program);
    if (!program) return program.error();
    const auto outcome = ask(request, question->number(), answer->number(), *program, progress);
    if (!outcome) return outcome.error();
    const bool may_have_replied =
        outcome->end == ChildOutcome::End::replied || outcome->end == ChildOutcome::End::not_known;
    if (!may_have_replied) return failure(request, *outcome);

    auto reply = map_reply(answer->number());
    if (!reply) return reply.error().code == ErrorCode::internal ? failure(request, *outcome) : reply.error();
    if (auto* error = std::get_if<Error>(&*reply)) return std::move(*error);
    return reply;
}

} // namespace isotet::io::confined
