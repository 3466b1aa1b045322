// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// How contestants of the race are spoken to: one line a command, words apart by tabs; one line of JSON a reply.
// C++17, for the rival's sake.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace isotet::bench {

/// The fields of a JSON object, in the order in which they were added.
class Reply {
public:
    Reply& number(const char* name, double value);
    Reply& count(const char* name, std::uint64_t value);
    Reply& text(const char* name, const std::string& value);

    std::string json() const { return "{" + fields_ + "}"; }

private:
    Reply& add(const char* name, const std::string& value);
    std::string fields_;
};

using Words = std::vector<std::string>;

/// Answers commands from the standard input until it ends. What `answer` throws becomes the reply {"error": "..."}.
/// "peak" before a command adds "peak_bytes" to its reply: resident memory at its highest, less that before it.
int serve(const std::function<Reply(const Words&)>& answer);

/// Word `index` of a command, or an exception that names the command.
const std::string& word(const Words& words, std::size_t index);
double number(const Words& words, std::size_t index);
int whole_number(const Words& words, std::size_t index);

class Stopwatch {
public:
    double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

} // namespace isotet::bench
