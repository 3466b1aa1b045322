// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What isotet uses of oneTBB, for one thread.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <optional>
#include <utility>

namespace tbb {

template <class Value>
class blocked_range {
public:
    blocked_range(Value begin, Value end, std::size_t grain = 1) : begin_(begin), end_(end), grain_(grain) {}
    Value begin() const { return begin_; }
    Value end() const { return end_; }
    std::size_t grainsize() const { return grain_; }
    std::size_t size() const { return static_cast<std::size_t>(end_ - begin_); }
    bool empty() const { return !(begin_ < end_); }

private:
    Value begin_, end_;
    std::size_t grain_;
};

template <class Range, class Body>
void parallel_for(const Range& range, const Body& body) {
    if (!range.empty()) body(range);
}

template <class Range, class Value, class Body, class Join>
Value parallel_reduce(const Range& range, const Value& none, const Body& body, const Join& join) {
    return range.empty() ? none : join(none, body(range, none));
}

template <class Iterator, class... Compare>
void parallel_sort(Iterator begin, Iterator end, const Compare&... compare) {
    std::sort(begin, end, compare...);
}

template <class... Bodies>
void parallel_invoke(const Bodies&... bodies) {
    (bodies(), ...);
}

/// The one thread's value, made when it is asked for.
template <class Value>
class enumerable_thread_specific {
public:
    enumerable_thread_specific() : make_([] { return Value(); }) {}
    template <class Make>
        requires std::is_invocable_r_v<Value, const Make&>
    explicit enumerable_thread_specific(Make make) : make_(std::move(make)) {}

    Value& local() {
        if (!value_) value_.emplace(make_());
        return *value_;
    }
    Value* begin() { return value_ ? &*value_ : nullptr; }
    Value* end() { return value_ ? &*value_ + 1 : nullptr; }
    std::size_t size() const { return value_ ? 1 : 0; }
    bool empty() const { return !value_; }
    void clear() { value_.reset(); }

private:
    std::function<Value()> make_;
    std::optional<Value> value_;
};

class global_control {
public:
    enum parameter { max_allowed_parallelism };
    global_control(parameter, std::size_t) {}
};

namespace info {
inline int default_concurrency() { return 1; }
} // namespace info

namespace this_task_arena {
inline int max_concurrency() { return 1; }
} // namespace this_task_arena

class task_arena {
public:
    explicit task_arena(int) {}
    void initialize() {}
    template <class Work>
    void execute(const Work& work) {
        work();
    }
};

} // namespace tbb
