// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <mutex>
#include <string>
#include <vector>

#include <isotet/jobs/job.hpp>

namespace isotet::view {

/// Passes all on, and keeps the notes for a page, each once.
class NoteKeeper : public jobs::Caller {
public:
    /// `caller`   outlives it
    explicit NoteKeeper(jobs::Caller& caller) : caller_(caller) { run_ = caller.run(); }

    void note(const std::string& sentence) override {
        caller_.note(sentence);
        const std::lock_guard lock(mutex_);
        if (!sentence.empty() && std::ranges::find(notes_, sentence) == notes_.end()) notes_.push_back(sentence);
    }
    void detail(const std::string& sentence) override { caller_.detail(sentence); }

    std::vector<std::string> notes_so_far() const {
        const std::lock_guard lock(mutex_);
        return notes_;
    }

private:
    jobs::Caller& caller_;
    mutable std::mutex mutex_;
    std::vector<std::string> notes_;
};

} // namespace isotet::view
