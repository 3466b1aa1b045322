// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What a command says while it works: results, notes, details, progress, and where each of them goes.
#pragma once

#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include <isotet/jobs/job.hpp>
#include <isotet/result.hpp>

#include "options/options.hpp"
#include "output/progress_bar.hpp"

namespace isotet::cli {

/// Threads   note(), notes(), detail(): any
/// run() has the threads that were asked for, draws the bar and stops at Ctrl-C; the console must outlive it.
class Console : public Caller {
public:
    explicit Console(const CommonOptions& options);

    /// A sentence for the user, on standard error and in the JSON; once however often it is noted. Not with --quiet.
    void note(const std::string& sentence) override;

    /// A sentence for --verbose, on standard error.
    void detail(const std::string& sentence) override;

    /// Text for people on standard output: not with --quiet, and not where the JSON goes there.
    Result<void> print(std::string_view text);

    const std::vector<std::string>& noted() const noexcept { return noted_; }

private:
    bool quiet_, verbose_, table_;
    ProgressBar bar_;
    std::mutex mutex_; ///< of what is written while working
    std::vector<std::string> noted_;
};

/// "isotet: MESSAGE" on standard error, escaped.
void say_error(std::string_view message);

} // namespace isotet::cli
