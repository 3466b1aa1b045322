// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// The thread that makes frames: for the newest wish of each page, page after page.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "view/messages.hpp"
#include "view/server/slot.hpp"

namespace isotet::view {

using PageNumber = std::uint64_t;

/// What answers wishes: GridView, or a test's. Called by the worker's thread alone.
class FrameMaker {
public:
    virtual ~FrameMaker() = default;
    /// Bytes of the frame; an error, which the page is told unless it is cancelled.
    virtual Result<std::string> frame(const ShowMessage& message, double wait_seconds, std::vector<std::string>& known,
                                      const Run& run) = 0;
    /// Text of the answer.
    virtual Result<std::string> chart(const ChartMessage& message, const Run& run) = 0;
    virtual Result<std::string> pick(const PickMessage& message, const Run& run);
    virtual Result<std::string> parts(const PartsMessage& message, const Run& run);
    virtual Result<std::string> share(const ShareMessage& message, const Run& run);
    /// Nothing is to be done for a while: memory may be given back.
    virtual void rest() {}
    virtual Result<std::string> spectrum(const SpectrumMessage& message, const Run& run);
};

/// How the worker answers. Called by the worker's thread.
struct WorkerOutput {
    std::function<void(PageNumber page, std::string bytes)> frame;
    std::function<void(PageNumber page, std::string text)> text;
};

/// Threads   safe from many threads
class Worker {
public:
    static constexpr double pause = 0.25;   ///< seconds before work in the background
    static constexpr double rest_pause = 2; ///< and before FrameMaker::rest(), once, after start_background()
    Worker(WorkerOutput output, std::function<double()> clock, SlotRules rules = {});
    Worker(const Worker&) = delete;
    Worker& operator=(const Worker&) = delete;
    ~Worker(); ///< cancels what is going on, and waits for its end

    /// From now on wishes are answered, those that wait already too.
    void start(std::shared_ptr<FrameMaker> maker);

    void add_page(PageNumber page);
    void remove_page(PageNumber page);
    void wish(PageNumber page, ShowMessage message);
    void ask_chart(PageNumber page, ChartMessage message); ///< of this and what follows the newest counts
    void ask_pick(PageNumber page, PickMessage message);
    void ask_share(PageNumber page, ShareMessage message);
    /// Begun after start_background(), when `pause` seconds nothing else was done, and begun anew when it was cancelled for
    /// something else.
    void ask_spectrum(PageNumber page, SpectrumMessage message);
    void ask_parts(PageNumber page, PartsMessage message);
    /// A frame with curved cells refined. The same; forgotten at the page's next wish.
    void ask_refined(PageNumber page, ShowMessage message);
    void start_background();
    void acknowledge(PageNumber page);

    /// To be called now and then: cancels work that became stale in the meantime.
    void look_for_stale_work();

private:
    struct Wish {
        ShowMessage message;
        double came = 0;
    };
    /// What a page asks, one of each kind.
    struct Question {
        std::string_view about;
        std::function<Result<std::string>(FrameMaker& maker, const Run& run)> answer;
    };
    struct Page {
        Slot<Wish> slot;
        std::vector<Question> now, later; ///< in the order in which they came; later: in the background
        std::optional<ShowMessage> refined;
        std::vector<std::string> known;
    };
    enum class When : std::uint8_t { now, later };

    void work();
    std::optional<PageNumber> next_page() const;
    void ask(PageNumber page, When when, Question question);
    void answer_now(std::unique_lock<std::mutex>& lock, PageNumber number);
    std::optional<PageNumber> next_in_background() const;
    void make_refined(std::unique_lock<std::mutex>& lock, PageNumber number);
    void answer_later(std::unique_lock<std::mutex>& lock, PageNumber number);
    void interrupt_background();
    void rest(std::unique_lock<std::mutex>& lock);
    void tell(PageNumber number, std::string_view about, Result<std::string> answer);
    void send_frame(PageNumber number, std::uint64_t wish, Result<std::string> frame);
    void make_frame(std::unique_lock<std::mutex>& lock, PageNumber number);
    void cancel_if_stale();

    WorkerOutput output_;
    std::function<double()> clock_;
    SlotRules rules_;
    std::mutex mutex_; ///< of all that follows
    std::condition_variable changed_;
    std::shared_ptr<FrameMaker> maker_;
    std::map<PageNumber, Page> pages_;
    PageNumber last_ = 0; ///< that was served
    std::optional<PageNumber> working_for_;
    bool has_background_ = false;   ///< start_background() was called
    bool is_in_background_ = false; ///< what is done now can be done later
    bool rested_ = true;            ///< rest() was called since
    double busy_ = 0;               ///< when something else was done last
    std::atomic<bool> cancel_{false};
    bool stop_ = false;
    std::thread thread_;
};

} // namespace isotet::view
