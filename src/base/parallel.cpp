// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "base/parallel.hpp"
#include "base/system/apart.hpp"

#ifndef __wasm__
#include <pthread.h>
#endif

#include <algorithm>
#include <atomic>
#include <cfenv>
#include <memory>
#include <mutex>
#include <set>
#include <utility>
#include <vector>

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace isotet::core {

namespace {

/// Lets the process use more threads than there are cores while a call needs them.
///
/// An arena alone never gets more workers than there are cores: a global_control has to allow them. Of several controls
/// the smallest rules, so calls that run at the same time share one that allows as many as the largest of them needs.
class MoreThreads {
public:
    void add(std::size_t count) {
        const std::lock_guard lock(mutex_);
        needed_.insert(count);
        follow();
    }
    void remove(std::size_t count) {
        const std::lock_guard lock(mutex_);
        needed_.erase(needed_.find(count));
        follow();
    }

private:
    void follow() {
        const std::size_t most = needed_.empty() ? 0 : *needed_.rbegin();
        if (most == allowed_) return;
        // The old one goes last: between the two the limit would be the number of cores.
        auto next = most == 0
                        ? nullptr
                        : std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism, most);
        control_ = std::move(next);
        allowed_ = most;
    }

    std::mutex mutex_;
    std::multiset<std::size_t> needed_; ///< by calls that are running
    std::unique_ptr<tbb::global_control> control_;
    std::size_t allowed_ = 0; ///< by the control; 0: there is none
};

/// Allows `count` threads while it lives.
class AllowThreads {
public:
    explicit AllowThreads(int count) : count_(static_cast<std::size_t>(count)) {
        if (is_needed()) everybody().add(count_);
    }
    ~AllowThreads() {
        if (is_needed()) everybody().remove(count_);
    }
    AllowThreads(const AllowThreads&) = delete;
    AllowThreads& operator=(const AllowThreads&) = delete;

private:
    static MoreThreads& everybody() {
        static MoreThreads all;
        return all;
    }
    bool is_needed() const { return count_ > static_cast<std::size_t>(tbb::info::default_concurrency()); }

    std::size_t count_;
};

/// Arenas that no call is in, kept for later ones: oneTBB keeps memory of each that a worker was in, and its threads
/// look through all of them.
class IdleArenas {
public:
    struct Arena {
        int threads;
        std::unique_ptr<tbb::task_arena> arena;
    };

    IdleArenas() { idle_.reserve(most); }

    Arena take(int threads) {
        std::unique_lock lock(mutex_);
        if (const auto at = std::ranges::find(idle_, threads, &Arena::threads); at != idle_.end()) {
            Arena arena = std::move(*at);
            idle_.erase(at);
            return arena;
        }
        lock.unlock();
        return {threads, made(threads)};
    }
    void give_back(Arena arena) noexcept {
        const std::lock_guard lock(mutex_);
        if (idle_.size() == most) idle_.erase(idle_.begin());
        idle_.push_back(std::move(arena));
    }
    void drop() noexcept {
        const std::lock_guard lock(mutex_);
        idle_.clear();
    }

    static IdleArenas& all() { return *kept().load(); }

private:
    static constexpr std::size_t most = 64;

    /// Work in an arena has the rounding and the treatment of denormals that there were when it was made.
    static std::unique_ptr<tbb::task_arena> made(int threads) {
        auto arena = std::make_unique<tbb::task_arena>(threads);
        std::fenv_t of_caller;
        std::fegetenv(&of_caller);
        std::fesetenv(FE_DFL_ENV);
        arena->initialize();
        std::fesetenv(&of_caller);
        return arena;
    }

    /// Not destroyed: oneTBB may be gone by then. A forked process has none of the threads, and begins anew.
    static std::atomic<IdleArenas*>& kept() {
        static std::atomic<IdleArenas*> arenas = [] {
#ifndef __wasm__
            ::pthread_atfork(nullptr, nullptr, [] {
                if (!starts_apart()) kept().store(new IdleArenas);
            });
#endif
            return new IdleArenas;
        }();
        return arenas;
    }

    std::mutex mutex_;
    std::vector<Arena> idle_;
};

/// An arena of one call.
class CallArena {
public:
    explicit CallArena(int threads) : arena_(IdleArenas::all().take(threads)) {}
    ~CallArena() { IdleArenas::all().give_back(std::move(arena_)); }
    CallArena(const CallArena&) = delete;
    CallArena& operator=(const CallArena&) = delete;

    void execute(const std::function<void()>& work) { arena_.arena->execute(work); }

private:
    IdleArenas::Arena arena_;
};

} // namespace

void with_threads(int threads, const std::function<void()>& work) {
    constexpr int most = 1024; // an arena takes memory for each thread it may get
    const int count = threads > 0 ? std::min(threads, most) : threads_here();
    const AllowThreads allowed(count);
    CallArena(count).execute(work);
}

void drop_idle_arenas() noexcept { IdleArenas::all().drop(); }

int threads_here() { return tbb::this_task_arena::max_concurrency(); }

void parallel_ranges(std::size_t count, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& body) {
    if (count <= grain) {
        if (count) body(0, count);
        return;
    }
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, grain),
                      [&](const tbb::blocked_range<std::size_t>& range) { body(range.begin(), range.end()); });
}

void parallel_pieces(std::size_t count, std::size_t grain, const Progress& progress,
                     const std::function<void(std::size_t, std::size_t)>& body) {
    parallel_each((count + grain - 1) / grain, 1, [&](std::size_t piece) {
        if (!progress.cancelled()) body(piece * grain, std::min(count, (piece + 1) * grain));
    });
}

} // namespace isotet::core
