// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Jobs go from files to files: they read, choose, extract or draw, and write, as the commands of the program do.
#pragma once

#include <algorithm>
#include <string>
#include <thread>
#include <vector>

#include <isotet/progress.hpp>

namespace isotet::jobs {

/// Who wants a job done: is told what happens meanwhile, and says how many threads there are and when to stop.
///
/// Sentences call an option by its name in the job's struct, in backquotes: "`merge_points` 0 joins them".
/// Threads   note() and detail() may be called by several at a time
class Caller {
public:
    virtual ~Caller() = default;

    /// A sentence that the user should read. An empty one is none.
    virtual void note(const std::string& sentence) = 0;

    /// What is done next.
    virtual void detail(const std::string& sentence) = 0;

    void notes(const std::vector<std::string>& sentences) {
        for (const std::string& sentence : sentences) note(sentence);
    }
    const Run& run() const noexcept { return run_; }
    unsigned threads() const noexcept { ///< at most
        return run_.threads > 0 ? static_cast<unsigned>(run_.threads)
                                : std::max(1U, std::thread::hardware_concurrency());
    }
    bool cancelled() const noexcept { return run_.progress.cancelled(); }

protected:
    Run run_;
};

} // namespace isotet::jobs
