// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "io/process/child_pool.hpp"

#include <algorithm>
#include <mutex>
#include <unistd.h>
#include <vector>

namespace isotet::io::confined {
namespace {

constexpr std::size_t max_idle = 4;

struct Idle {
    std::string key;
    std::unique_ptr<ReaderChild> child;
};

struct Pool {
    std::mutex mutex;
    pid_t owner = ::getpid();
    std::vector<Idle> idle; ///< the one that has waited longest first

    /// In a process that was forked off, the children are its parent's.
    void adopt() {
        if (owner == ::getpid()) return;
        for (Idle& other : idle) other.child->abandon();
        idle.clear();
        owner = ::getpid();
    }
};

/// Never destroyed: threads may still read while the program ends, and the system closes the sockets.
Pool& pool() {
    static Pool& only = *new Pool;
    return only;
}

} // namespace

std::unique_ptr<ReaderChild> take_idle_child(const std::string& key) {
    const std::scoped_lock lock(pool().mutex);
    pool().adopt();
    auto& idle = pool().idle;
    const auto found = std::ranges::find(idle, key, &Idle::key);
    if (found == idle.end()) return nullptr;
    auto child = std::move(found->child);
    idle.erase(found);
    return child;
}

void keep_idle_child(std::string key, std::unique_ptr<ReaderChild> child) {
    std::unique_ptr<ReaderChild> surplus; // ended outside the lock
    const std::scoped_lock lock(pool().mutex);
    pool().adopt();
    auto& idle = pool().idle;
    if (idle.size() == max_idle) {
        surplus = std::move(idle.front().child);
        idle.erase(idle.begin());
    }
    idle.push_back({std::move(key), std::move(child)});
}

} // namespace isotet::io::confined
