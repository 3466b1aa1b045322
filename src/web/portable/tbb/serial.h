// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// What isotet uses of oneTBB, for one thread. With workers (web_workers.h), sums are theirs too, and each has values of
// its own.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <utility>
#ifdef ISOTET_WEB_WORKERS
#include <vector>

#include <web_workers.h>
#endif

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
#ifdef ISOTET_WEB_WORKERS
    const std::size_t pieces = range.empty() ? 0 : web_workers::piece_count(range.size(), range.grainsize());
    std::vector<std::optional<Value>> parts(pieces);
    const auto at = [&](std::size_t piece) { return range.begin() + web_workers::piece_begin(range.size(), piece, pieces); };
    web_workers::share(pieces, [&](std::size_t i) { parts[i].emplace(body(Range(at(i), at(i + 1), range.grainsize()), none)); });
    Value all = none;
    for (std::optional<Value>& part : parts) all = join(all, *std::move(part));
    return all;
#else
    return range.empty() ? none : join(none, body(range, none));
#endif
}

template <class Iterator, class... Compare>
void parallel_sort(Iterator begin, Iterator end, const Compare&... compare) {
    std::sort(begin, end, compare...);
}

template <class... Bodies>
void parallel_invoke(const Bodies&... bodies) {
    (bodies(), ...);
}

#ifdef ISOTET_WEB_WORKERS
/// Each thread's value, made when it is asked for.
template <class Value>
class enumerable_thread_specific {
    using Values = std::array<std::optional<Value>, web_workers::max_threads>;

public:
    class iterator {
    public:
        using value_type = Value;
        using difference_type = std::ptrdiff_t;
        iterator() = default;
        explicit iterator(std::optional<Value>* at, std::optional<Value>* end) : at_(at), end_(end) { skip_empty(); }
        Value& operator*() const { return **at_; }
        Value* operator->() const { return &**at_; }
        iterator& operator++() {
            ++at_;
            skip_empty();
            return *this;
        }
        iterator operator++(int) {
            const iterator before = *this;
            ++*this;
            return before;
        }
        bool operator==(const iterator& other) const { return at_ == other.at_; }

    private:
        void skip_empty() {
            while (at_ != end_ && !*at_) ++at_;
        }
        std::optional<Value>*at_ = nullptr, *end_ = nullptr;
    };

    enumerable_thread_specific() : make_([] { return Value(); }) {}
    template <class Make>
        requires std::is_invocable_r_v<Value, const Make&>
    explicit enumerable_thread_specific(Make make) : make_(std::move(make)) {}

    Value& local() {
        std::optional<Value>& own = values_[web_workers::here];
        if (!own) own.emplace(make_());
        return *own;
    }
    iterator begin() { return iterator(values_.data(), values_.data() + values_.size()); }
    iterator end() { return iterator(values_.data() + values_.size(), values_.data() + values_.size()); }
    std::size_t size() const {
        std::size_t count = 0;
        for (const std::optional<Value>& value : values_) count += value.has_value();
        return count;
    }
    bool empty() const { return size() == 0; }
    void clear() { values_ = {}; }

private:
    std::function<Value()> make_;
    Values values_;
};
#else
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
#endif

class global_control {
public:
    enum parameter { max_allowed_parallelism };
    global_control(parameter, std::size_t) {}
};

namespace info {
inline int default_concurrency() { return 1; }
} // namespace info

namespace this_task_arena {
#ifdef ISOTET_WEB_WORKERS
inline int max_concurrency() { return static_cast<int>(web_workers::threads.load()); }
#else
inline int max_concurrency() { return 1; }
#endif
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
