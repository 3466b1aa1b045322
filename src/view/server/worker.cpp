// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "view/server/worker.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

namespace isotet::view {

Worker::Worker(WorkerOutput output, std::function<double()> clock, SlotRules rules)
    : output_(std::move(output)), clock_(std::move(clock)), rules_(rules), thread_([this] { work(); }) {}

Worker::~Worker() {
    {
        const std::lock_guard lock(mutex_);
        stop_ = true;
        cancel_ = true;
    }
    changed_.notify_all();
    thread_.join();
}

void Worker::start(std::shared_ptr<FrameMaker> maker) {
    {
        const std::lock_guard lock(mutex_);
        maker_ = std::move(maker);
    }
    changed_.notify_all();
}

void Worker::add_page(PageNumber page) {
    const std::lock_guard lock(mutex_);
    pages_.emplace(page, Page{Slot<Wish>(rules_), {}, {}, {}, {}});
}

void Worker::remove_page(PageNumber page) {
    const std::lock_guard lock(mutex_);
    pages_.erase(page);
    if (working_for_ == page) cancel_ = true;
    interrupt_background();
}

void Worker::wish(PageNumber page, ShowMessage message) {
    {
        const std::lock_guard lock(mutex_);
        const auto found = pages_.find(page);
        if (found == pages_.end()) return;
        found->second.slot.put({std::move(message), clock_()});
        found->second.refined.reset();
        cancel_if_stale();
        interrupt_background();
    }
    changed_.notify_all();
}

void Worker::ask(PageNumber page, When when, Question question) {
    {
        const std::lock_guard lock(mutex_);
        const auto found = pages_.find(page);
        if (found == pages_.end()) return;
        std::vector<Question>& asked = when == When::now ? found->second.now : found->second.later;
        std::erase_if(asked, [&](const Question& one) { return one.about == question.about; });
        asked.push_back(std::move(question));
        interrupt_background();
    }
    changed_.notify_all();
}

void Worker::ask_chart(PageNumber page, ChartMessage message) {
    ask(page, When::now, {"chart", [message = std::move(message)](FrameMaker& maker, const Run& run) {
                              return maker.chart(message, run);
                          }});
}

void Worker::ask_pick(PageNumber page, PickMessage message) {
    ask(page, When::now, {"pick", [message = std::move(message)](FrameMaker& maker, const Run& run) {
                              return maker.pick(message, run);
                          }});
}

void Worker::ask_share(PageNumber page, ShareMessage message) {
    ask(page, When::now, {"share", [message = std::move(message)](FrameMaker& maker, const Run& run) {
                              return maker.share(message, run);
                          }});
}

void Worker::ask_spectrum(PageNumber page, SpectrumMessage message) {
    ask(page, When::later, {"spectrum", [message = std::move(message)](FrameMaker& maker, const Run& run) {
                                return maker.spectrum(message, run);
                            }});
}

void Worker::ask_parts(PageNumber page, PartsMessage message) {
    ask(page, When::later, {"parts", [message = std::move(message)](FrameMaker& maker, const Run& run) {
                                return maker.parts(message, run);
                            }});
}

void Worker::ask_refined(PageNumber page, ShowMessage message) {
    {
        const std::lock_guard lock(mutex_);
        const auto found = pages_.find(page);
        if (found == pages_.end()) return;
        found->second.refined = std::move(message);
        interrupt_background();
    }
    changed_.notify_all();
}

void Worker::start_background() {
    {
        const std::lock_guard lock(mutex_);
        has_background_ = true;
        rested_ = false;
    }
    changed_.notify_all();
}

void Worker::interrupt_background() {
    busy_ = clock_();
    if (is_in_background_) cancel_ = true;
}

void Worker::acknowledge(PageNumber page) {
    {
        const std::lock_guard lock(mutex_);
        const auto found = pages_.find(page);
        if (found == pages_.end()) return;
        found->second.slot.acknowledge();
    }
    changed_.notify_all();
}

void Worker::look_for_stale_work() {
    const std::lock_guard lock(mutex_);
    cancel_if_stale();
}

void Worker::cancel_if_stale() {
    if (!working_for_) return;
    const auto found = pages_.find(*working_for_);
    if (found != pages_.end() && found->second.slot.is_stale(clock_())) cancel_ = true;
}

/// The next page behind the one that was served last that wants something.
std::optional<PageNumber> Worker::next_page() const {
    if (!maker_) return std::nullopt;
    const auto wants = [](const Page& page) { return !page.now.empty() || page.slot.ready(); };
    for (auto at = pages_.upper_bound(last_); at != pages_.end(); ++at)
        if (wants(at->second)) return at->first;
    for (const auto& [number, page] : pages_)
        if (wants(page)) return number;
    return std::nullopt;
}

void Worker::work() {
    std::unique_lock lock(mutex_);
    while (!stop_) {
        const std::optional<PageNumber> number = next_page();
        if (!number) {
            const std::optional<PageNumber> later = next_in_background();
            const double idle = clock_() - busy_;
            const bool restless = maker_ && has_background_ && !rested_;
            if (later && idle >= pause && pages_.at(*later).refined) make_refined(lock, *later);
            else if (later && idle >= pause) answer_later(lock, *later);
            else if (!later && restless && idle >= rest_pause) rest(lock);
            else if (later || restless) changed_.wait_for(lock, std::chrono::milliseconds(20));
            else changed_.wait(lock);
            continue;
        }
        last_ = *number;
        if (!pages_.at(*number).now.empty()) answer_now(lock, *number);
        else make_frame(lock, *number);
        busy_ = clock_();
        rested_ = false;
    }
}

void Worker::rest(std::unique_lock<std::mutex>& lock) {
    const std::shared_ptr<FrameMaker> maker = maker_;
    rested_ = true;
    lock.unlock();
    maker->rest();
    lock.lock();
}

std::optional<PageNumber> Worker::next_in_background() const {
    if (!maker_ || !has_background_) return std::nullopt;
    for (const auto& [number, page] : pages_)
        if (!page.later.empty() || page.refined) return number;
    return std::nullopt;
}

/// What is wanted stays wanted while it is made: a cancelled frame is made anew, unless the page wishes something else.
void Worker::make_refined(std::unique_lock<std::mutex>& lock, PageNumber number) {
    const ShowMessage message = *pages_.at(number).refined;
    std::vector<std::string> known = pages_.at(number).known;
    const std::shared_ptr<FrameMaker> maker = maker_;
    is_in_background_ = true;
    cancel_ = stop_;
    lock.unlock();
    Result<std::string> frame = maker->frame(message, 0, known, {0, {{}, &cancel_}});
    lock.lock();
    is_in_background_ = false;
    rested_ = false;
    busy_ = clock_();
    const auto page = pages_.find(number);
    const bool cancelled = !frame && frame.error().code == ErrorCode::cancelled;
    if (page == pages_.end() || cancelled) return;
    page->second.refined.reset();
    if (frame) page->second.known = std::move(known);
    lock.unlock();
    send_frame(number, message.number, std::move(frame));
    lock.lock();
}

void Worker::send_frame(PageNumber number, std::uint64_t wish, Result<std::string> frame) {
    if (frame) output_.frame(number, *std::move(frame));
    else if (frame.error().code != ErrorCode::cancelled)
        output_.text(number, refusal_text(wish, frame.error().message));
}

void Worker::answer_later(std::unique_lock<std::mutex>& lock, PageNumber number) {
    std::vector<Question>& asked = pages_.at(number).later;
    Question question = std::move(asked.front());
    asked.erase(asked.begin());
    const std::shared_ptr<FrameMaker> maker = maker_;
    is_in_background_ = true;
    cancel_ = stop_;
    lock.unlock();
    Result<std::string> answer = question.answer(*maker, {0, {{}, &cancel_}});
    const bool cancelled = !answer && answer.error().code == ErrorCode::cancelled;
    if (!cancelled) tell(number, question.about, std::move(answer));
    lock.lock();
    is_in_background_ = false;
    rested_ = false;
    busy_ = clock_();
    const auto page = pages_.find(number);
    if (!cancelled || page == pages_.end()) return;
    std::vector<Question>& again = page->second.later;
    if (std::ranges::find(again, question.about, &Question::about) == again.end())
        again.insert(again.begin(), std::move(question));
}

void Worker::answer_now(std::unique_lock<std::mutex>& lock, PageNumber number) {
    std::vector<Question>& asked = pages_.at(number).now;
    const Question question = std::move(asked.front());
    asked.erase(asked.begin());
    const std::shared_ptr<FrameMaker> maker = maker_;
    cancel_ = stop_;
    lock.unlock();
    tell(number, question.about, question.answer(*maker, {0, {{}, &cancel_}}));
    lock.lock();
}

void Worker::tell(PageNumber number, std::string_view about, Result<std::string> answer) {
    if (answer) output_.text(number, *std::move(answer));
    else if (answer.error().code != ErrorCode::cancelled)
        output_.text(number, error_text(about, answer.error().message));
}

Result<std::string> FrameMaker::pick(const PickMessage&, const Run&) {
    return Error{ErrorCode::invalid_argument, "nothing can be picked here"};
}

Result<std::string> FrameMaker::parts(const PartsMessage&, const Run&) {
    return Error{ErrorCode::invalid_argument, "there are no parts here"};
}

Result<std::string> FrameMaker::share(const ShareMessage&, const Run&) {
    return Error{ErrorCode::invalid_argument, "there are no shares here"};
}

Result<std::string> FrameMaker::spectrum(const SpectrumMessage&, const Run&) {
    return Error{ErrorCode::invalid_argument, "nothing can be measured here"};
}

void Worker::make_frame(std::unique_lock<std::mutex>& lock, PageNumber number) {
    Page& page = pages_.at(number);
    const double now = clock_();
    const std::optional<Wish> wish = page.slot.take(now);
    std::vector<std::string> known = page.known;
    const std::shared_ptr<FrameMaker> maker = maker_;
    working_for_ = number;
    cancel_ = stop_;
    lock.unlock();
    Result<std::string> frame = maker->frame(wish->message, now - wish->came, known, {0, {{}, &cancel_}});
    const bool made = static_cast<bool>(frame);
    const bool cancelled = !made && frame.error().code == ErrorCode::cancelled;
    lock.lock();
    working_for_.reset();
    const auto found = pages_.find(number);
    if (found == pages_.end()) return;
    using End = Slot<Wish>::End;
    found->second.slot.finish(made ? End::frame : cancelled ? End::cancelled : End::nothing);
    if (made) found->second.known = std::move(known);
    lock.unlock();
    send_frame(number, wish->message.number, std::move(frame));
    lock.lock();
}

} // namespace isotet::view
