// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The program isotet, run by tests of its command line.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "files/sample_files.hpp"
#include "support/places.hpp"
#include "support/run_program.hpp"

namespace isotet::test {

inline RunResult isotet(std::vector<std::string> arguments, const RunOptions& options = {}) {
    arguments.insert(arguments.begin(), program_path());
    return run_program(std::move(arguments), options);
}

/// A test with an empty folder of its own.
class Program : public testing::Test {
protected:
    std::string path(std::string_view name) const { return folder / name; }
    Folder folder;
};

/// The JSON on standard output of a run that must end well.
inline nlohmann::json json_of(std::vector<std::string> arguments, int status = 0) {
    arguments.insert(arguments.end(), {"--json", "-"});
    const RunResult run = isotet(std::move(arguments));
    EXPECT_EQ(run.status, status) << run.err;
    return nlohmann::json::parse(run.out, nullptr, false);
}

/// True when one line of standard error is "isotet: ..." and holds `text`, and no other line is there.
inline testing::AssertionResult is_one_error(const RunResult& run, std::string_view text) {
    const bool one_line = run.err.starts_with("isotet: ") && run.err.find('\n') == run.err.size() - 1;
    if (one_line && run.err.find(text) != std::string::npos) return testing::AssertionSuccess();
    return testing::AssertionFailure() << "standard error is: " << run.err << "but should be one line with: " << text;
}

} // namespace isotet::test
