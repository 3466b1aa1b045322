// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <mutex>
#include <string>
#include <vector>

#include <isotet/jobs/job.hpp>

namespace isotet::test {

/// A caller that keeps what it is told.
class Listener : public jobs::Caller {
public:
    explicit Listener(int threads = 0) {
        run_.threads = threads;
        run_.progress.cancel = &stop;
    }

    void note(const std::string& sentence) override {
        const std::lock_guard lock(mutex_);
        if (!sentence.empty()) noted.push_back(sentence);
    }
    void detail(const std::string& sentence) override {
        const std::lock_guard lock(mutex_);
        details.push_back(sentence);
    }

    std::vector<std::string> noted, details;
    std::atomic<bool> stop = false;

private:
    std::mutex mutex_;
};

} // namespace isotet::test
