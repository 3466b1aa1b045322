// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "call.hpp"

#include <pthread.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <string>
#include <thread>

namespace isotet::python {

using namespace nb::literals;

namespace {

using namespace std::chrono_literals;

PyObject* error_class = nullptr;
unsigned long main_thread = 0;

/// A thread that does one piece of work at a time. It is kept: starting one takes longer than a small extraction.
class Worker {
public:
    Worker() {
        std::thread([this] { loop(); }).detach();
    }

    void start(const std::function<void()>& work) {
        const std::lock_guard lock(mutex_);
        work_ = &work;
        wake_.notify_one();
    }

    /// Whether the work is done. What the work asks for meanwhile is done here.
    bool wait(std::chrono::milliseconds time) {
        std::unique_lock lock(mutex_);
        done_.wait_for(lock, time, [&] { return !work_ || asked_; });
        if (asked_) {
            const std::function<void()>* const asked = asked_;
            lock.unlock();
            (*asked)();
            lock.lock();
            asked_ = nullptr;
            answered_.notify_one();
        }
        return !work_;
    }

    /// Called by the work: has something done by the thread that waits for it, and waits until it is.
    void ask(const std::function<void()>& something) {
        std::unique_lock lock(mutex_);
        asked_ = &something;
        done_.notify_one();
        while (asked_) answered_.wait_for(lock, 1h);
    }

private:
    void loop() {
        std::unique_lock lock(mutex_);
        for (;;) {
            while (!work_)
                wake_.wait_for(lock, 1h); // wait() would need libstdc++ 12, which is newer than the wheel asks for
            lock.unlock();
            (*work_)();
            lock.lock();
            work_ = nullptr;
            done_.notify_one();
        }
    }

    std::mutex mutex_;
    std::condition_variable wake_, done_, answered_;
    const std::function<void()>* work_ = nullptr;
    const std::function<void()>* asked_ = nullptr;
};

thread_local Sessions telling; ///< sessions of the calls whose progress functions run on this thread

Worker* worker = nullptr; // never deleted: its thread may outlive everything
bool worker_is_busy = false;

} // namespace

void prepare_calls(nb::module_& module) {
    nb::class_<CallOptions>(module, "CallOptions")
        .def(
            "__init__",
            [](CallOptions* self, int threads, nb::object progress) {
                new (self) CallOptions{threads, std::move(progress)};
            },
            "threads"_a, "progress"_a.none());

    error_class = PyErr_NewExceptionWithDoc(
        "isotet.Error",
        "What is no ValueError, MemoryError or OSError: the system refused something, or isotet is at fault.", nullptr,
        nullptr);
    if (!error_class) throw nb::python_error();
    module.attr("Error") = nb::handle(error_class);
    main_thread = nb::cast<unsigned long>(nb::module_::import_("threading").attr("main_thread")().attr("ident"));
    pthread_atfork(nullptr, nullptr, [] {
        worker = nullptr; // a forked process has none of the threads
        worker_is_busy = false;
        main_thread = PyThread_get_thread_ident();
    });
}

void raise(const Error& error) {
    PyObject* type = error_class;
    switch (error.code) {
    case ErrorCode::invalid_argument:
    case ErrorCode::invalid_data: type = PyExc_ValueError; break;
    case ErrorCode::out_of_memory: type = PyExc_MemoryError; break;
    case ErrorCode::file:
    case ErrorCode::cannot_write: type = PyExc_OSError; break;
    case ErrorCode::no_device:
    case ErrorCode::device_failed:
    case ErrorCode::system:
    case ErrorCode::cancelled:
    case ErrorCode::internal: break;
    }
    PyErr_SetString(type, error.message.c_str());
    throw nb::python_error();
}

void refuse_inside(const Sessions& sessions) {
    for (const void* session : sessions) {
        if (std::find(telling.begin(), telling.end(), session) == telling.end()) continue;
        PyErr_SetString(
            PyExc_RuntimeError,
            "a progress function uses the session that it is called by, which is at work: use it after the call");
        throw nb::python_error();
    }
}

Call::Call(const CallOptions& options, Sessions sessions)
    : progress_(options.progress), sessions_(std::move(sessions)) {
    refuse_inside(sessions_);
    run_.threads = options.threads;
    run_.progress.cancel = &cancel_;
    if (progress_.is_valid() && !progress_.is_none())
        run_.progress.report = [this](std::string_view step, double fraction) { report(step, fraction); };
}

void Call::stop(nb::python_error&& error) {
    const std::lock_guard lock(mutex_);
    if (!stopped_) stopped_.emplace(std::move(error));
    cancel_ = true;
}

void Call::tell(std::string_view step, double fraction) {
    const nb::gil_scoped_acquire held;
    if (cancel_) return;
    const std::size_t before = telling.size();
    telling.insert(telling.end(), sessions_.begin(), sessions_.end());
    try {
        progress_(nb::str(step.data(), step.size()), fraction);
    } catch (nb::python_error& error) {
        stop(std::move(error));
    }
    telling.resize(before);
}

void Call::report(std::string_view step, double fraction) {
    if (!waiting_) return tell(step, fraction);
    worker->ask([&] { tell(step, fraction); });
}

void Call::wait_for_worker(const std::function<void()>& work) {
    worker_is_busy = true;
    waiting_ = true;
    if (!worker) worker = new Worker;
    {
        const nb::gil_scoped_release released;
        worker->start(work);
        while (!worker->wait(50ms)) {
            const nb::gil_scoped_acquire held;
            if (!cancel_ && PyErr_CheckSignals() != 0) stop(nb::python_error());
        }
    }
    worker_is_busy = false;
}

void Call::carry_out(const std::function<void()>& work) {
    std::exception_ptr thrown;
    const std::function<void()> guarded = [&] {
        try {
            work();
        } catch (...) {
            thrown = std::current_exception();
        }
    };
    if (PyThread_get_thread_ident() == main_thread && !worker_is_busy) {
        wait_for_worker(guarded);
    } else {
        const nb::gil_scoped_release released;
        guarded();
    }
    if (stopped_) throw std::move(*stopped_);
    if (thrown) std::rethrow_exception(thrown);
}

} // namespace isotet::python
