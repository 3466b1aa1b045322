// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The worker's thread with an engine that works until the test lets it end.
#include <gtest/gtest.h>

#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>

#include "view/server/worker.hpp"

namespace isotet::test {
namespace {

using namespace view;

/// Works on a wish until it is let go or cancelled; tells what it began.
class HeldEngine : public FrameMaker {
public:
    Result<std::string> frame(const ShowMessage& message, double, std::vector<std::string>& known,
                              const Run& run) override {
        std::unique_lock lock(mutex_);
        begun_.push_back(message.number);
        changed_.notify_all();
        while (let_go_ == 0 && !free_) {
            if (run.progress.cancelled()) return Error{ErrorCode::cancelled, "cancelled"};
            changed_.wait_for(lock, std::chrono::milliseconds(1));
        }
        if (let_go_ > 0) --let_go_;
        if (message.state.field == "wrong") return Error{ErrorCode::invalid_argument, "there is no such field"};
        known = {std::to_string(message.number)};
        return std::to_string(message.number);
    }
    Result<std::string> chart(const ChartMessage& message, const Run&) override { return "chart of " + message.field; }

    /// Works until it is cancelled the first time; then at once.
    Result<std::string> spectrum(const SpectrumMessage& message, const Run& run) override {
        std::unique_lock lock(mutex_);
        ++spectra_;
        changed_.notify_all();
        while (spectra_ == 1 && !run.progress.cancelled()) changed_.wait_for(lock, std::chrono::milliseconds(1));
        if (run.progress.cancelled()) return Error{ErrorCode::cancelled, "cancelled"};
        return "spectrum of " + message.field;
    }
    /// Lets time pass until a spectrum was begun so many times.
    void spectra(int count, std::atomic<double>& now) {
        std::unique_lock lock(mutex_);
        while (spectra_ < count) {
            now = now + 1;
            changed_.wait_for(lock, std::chrono::milliseconds(1));
        }
    }
    int spectra() {
        const std::lock_guard lock(mutex_);
        return spectra_;
    }

    void let_go() {
        set([&] { ++let_go_; });
    }
    void set_free() {
        set([&] { free_ = true; });
    }
    bool has_begun(std::size_t count) {
        const std::lock_guard lock(mutex_);
        return begun_.size() >= count;
    }
    /// Waits until so many wishes were begun.
    std::vector<std::uint64_t> begun(std::size_t count) {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [&] { return begun_.size() >= count; });
        return begun_;
    }

private:
    template <class Change>
    void set(const Change& change) {
        const std::lock_guard lock(mutex_);
        change();
        changed_.notify_all();
    }
    std::mutex mutex_;
    std::condition_variable changed_;
    std::vector<std::uint64_t> begun_;
    int let_go_ = 0, spectra_ = 0;
    bool free_ = false;
};

/// What the worker sent, in order: "frame 3", or the text.
class Sent {
public:
    void add(PageNumber page, std::string what) {
        const std::lock_guard lock(mutex_);
        all_.emplace_back(page, std::move(what));
        changed_.notify_all();
    }
    std::vector<std::string> to(PageNumber page, std::size_t count) {
        std::unique_lock lock(mutex_);
        std::vector<std::string> found;
        changed_.wait(lock, [&] {
            found.clear();
            for (const auto& [to, what] : all_)
                if (to == page) found.push_back(what);
            return found.size() >= count;
        });
        return found;
    }

private:
    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<std::pair<PageNumber, std::string>> all_;
};

class WorkerTest : public testing::Test {
protected:
    std::atomic<double> now_{0};
    Sent sent_;
    std::shared_ptr<HeldEngine> engine_ = std::make_shared<HeldEngine>();
    Worker worker_{WorkerOutput{[&](PageNumber page, std::string bytes) { sent_.add(page, "frame " + bytes); },
                                [&](PageNumber page, std::string text) { sent_.add(page, std::move(text)); }},
                   [&] { return now_.load(); }};

    void wish(PageNumber page, std::uint64_t number, const std::string& field = "p") {
        ShowMessage message;
        message.number = number;
        message.state.field = field;
        worker_.wish(page, message);
    }
};

TEST_F(WorkerTest, ABurstOfWishesGivesTheFirstAndTheLast) {
    worker_.add_page(1);
    worker_.start(engine_);
    wish(1, 1);
    engine_->begun(1);
    for (std::uint64_t number = 2; number <= 100; ++number) wish(1, number);
    engine_->set_free();
    EXPECT_EQ(sent_.to(1, 2), (std::vector<std::string>{"frame 1", "frame 100"}));
    EXPECT_EQ(engine_->begun(2), (std::vector<std::uint64_t>{1, 100}));
}

TEST_F(WorkerTest, WishesFromBeforeTheGridWasReadAreAnswered) {
    worker_.add_page(1);
    wish(1, 1);
    wish(1, 2);
    engine_->set_free();
    worker_.start(engine_);
    EXPECT_EQ(sent_.to(1, 1), (std::vector<std::string>{"frame 2"}));
}

TEST_F(WorkerTest, LongWorkIsCancelledForANewerWish) {
    worker_.add_page(1);
    worker_.start(engine_);
    wish(1, 1);
    engine_->begun(1);
    now_ = 5;
    wish(1, 2);
    EXPECT_EQ(engine_->begun(2), (std::vector<std::uint64_t>{1, 2}));
    engine_->let_go();
    EXPECT_EQ(sent_.to(1, 1), (std::vector<std::string>{"frame 2"}));
}

TEST_F(WorkerTest, WorkThatBecomesLongAfterTheLastWishIsCancelled) {
    worker_.add_page(1);
    worker_.start(engine_);
    wish(1, 1);
    engine_->begun(1);
    wish(1, 2);
    now_ = 5;
    worker_.look_for_stale_work();
    EXPECT_EQ(engine_->begun(2), (std::vector<std::uint64_t>{1, 2}));
    engine_->let_go();
    EXPECT_EQ(sent_.to(1, 1), (std::vector<std::string>{"frame 2"}));
}

TEST_F(WorkerTest, APageThatAcknowledgesNothingGetsTwoFrames) {
    worker_.add_page(1);
    worker_.add_page(2);
    engine_->set_free();
    worker_.start(engine_);
    for (std::uint64_t number = 1; number <= 2; ++number) {
        wish(1, number);
        sent_.to(1, number);
    }
    wish(1, 3);
    wish(2, 7); // shows that the worker goes on
    EXPECT_EQ(sent_.to(2, 1), (std::vector<std::string>{"frame 7"}));
    EXPECT_EQ(sent_.to(1, 2).size(), 2U);
    worker_.acknowledge(1);
    EXPECT_EQ(sent_.to(1, 3).back(), "frame 3");
}

TEST_F(WorkerTest, PagesTakeTurns) {
    worker_.add_page(1);
    worker_.add_page(2);
    worker_.start(engine_);
    wish(1, 1);
    engine_->begun(1);
    wish(1, 2);
    wish(2, 21);
    engine_->let_go();
    EXPECT_EQ(engine_->begun(2), (std::vector<std::uint64_t>{1, 21}));
    engine_->set_free();
    EXPECT_EQ(sent_.to(1, 2).size(), 2U);
}

TEST_F(WorkerTest, AnErrorIsTheSentenceAndTheNextWishIsAnswered) {
    worker_.add_page(1);
    engine_->set_free();
    worker_.start(engine_);
    wish(1, 1, "wrong");
    EXPECT_EQ(sent_.to(1, 1).front(), R"({"say":"refused","number":1,"sentence":"there is no such field"})");
    wish(1, 2);
    EXPECT_EQ(sent_.to(1, 2).back(), "frame 2");
}

TEST_F(WorkerTest, APageThatGoesIsWorkedForNoMore) {
    worker_.add_page(1);
    worker_.add_page(2);
    worker_.start(engine_);
    wish(1, 1);
    engine_->begun(1);
    worker_.remove_page(1);
    wish(2, 2);
    EXPECT_EQ(engine_->begun(2), (std::vector<std::uint64_t>{1, 2}));
}

TEST_F(WorkerTest, ChartsComeBeforeFrames) {
    worker_.add_page(1);
    wish(1, 1);
    worker_.ask_chart(1, {"p"});
    worker_.ask_chart(1, {"q"});
    engine_->set_free();
    worker_.start(engine_);
    EXPECT_EQ(sent_.to(1, 2), (std::vector<std::string>{"chart of q", "frame 1"}));
}

TEST_F(WorkerTest, ASpectrumIsCancelledForAWishAndBegunAgain) {
    worker_.add_page(1);
    engine_->set_free();
    worker_.start(engine_);
    worker_.start_background();
    worker_.ask_spectrum(1, {"p"});
    engine_->spectra(1, now_);
    wish(1, 1);
    EXPECT_EQ(sent_.to(1, 1).back(), "frame 1");
    engine_->spectra(2, now_);
    EXPECT_EQ(sent_.to(1, 2).back(), "spectrum of p");
}

TEST_F(WorkerTest, ASpectrumWaitsForThePauseAfterAFrame) {
    worker_.add_page(1);
    engine_->set_free();
    worker_.start(engine_);
    worker_.start_background();
    now_ = 10;
    worker_.ask_spectrum(1, {"p"});
    for (std::uint64_t number = 1; number <= 20; ++number) { // a hand that moves: none is begun
        wish(1, number);
        sent_.to(1, number);
        worker_.acknowledge(1);
        now_ = now_ + Worker::pause / 2;
    }
    EXPECT_EQ(engine_->spectra(), 0);
    engine_->spectra(1, now_);
}

TEST_F(WorkerTest, ARefinedFrameIsMadeWhenNothingElseIs) {
    worker_.add_page(1);
    worker_.start(engine_);
    worker_.start_background();
    const auto ask = [&](std::uint64_t number) {
        ShowMessage message;
        message.number = number;
        message.refined = true;
        worker_.ask_refined(1, message);
    };
    const auto until_begun = [&](std::size_t count) {
        for (now_ = now_ + 1; !engine_->has_begun(count); now_ = now_ + 1)
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
    };
    ask(1);
    until_begun(1);
    worker_.ask_chart(1, {"p"}); // not what the frame is of: it is begun again
    EXPECT_EQ(sent_.to(1, 1).back(), "chart of p");
    until_begun(2);
    engine_->let_go();
    EXPECT_EQ(sent_.to(1, 2).back(), "frame 1");
    ask(2);
    until_begun(3);
    wish(1, 3); // the page moved on: the refined frame is forgotten
    engine_->begun(4);
    engine_->set_free();
    EXPECT_EQ(sent_.to(1, 3).back(), "frame 3");
    now_ = now_ + 10;
    worker_.ask_spectrum(1, {"p"});
    engine_->spectra(1, now_);
    EXPECT_EQ(engine_->begun(4), (std::vector<std::uint64_t>{1, 1, 2, 3}));
}

} // namespace
} // namespace isotet::test
