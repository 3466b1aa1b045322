// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// A fixed-size array that is not cleared when it is made: large arrays are first touched by the threads that fill them.
// Its memory comes from blocks (base/block.hpp).
#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <new>
#include <span>
#include <type_traits>
#include <utility>

#include <isotet/array.hpp>

#include "base/system/block.hpp"

namespace isotet::core {

template <class T>
class Buffer {
    static_assert(std::is_trivially_copyable_v<T>);

public:
    Buffer() = default;
    explicit Buffer(std::size_t size) : size_(size) {
        if (size > std::numeric_limits<std::size_t>::max() / sizeof(T)) throw std::bad_array_new_length();
        const Block block = take_block(size * sizeof(T));
        data_ = {static_cast<T*>(block.data), GiveBack{block.bytes}};
    }

    T* data() noexcept { return data_.get(); }
    const T* data() const noexcept { return data_.get(); }
    std::size_t size() const noexcept { return size_; }
    std::size_t bytes() const noexcept { return size_ * sizeof(T); }
    bool empty() const noexcept { return size_ == 0; }
    T& operator[](std::size_t i) noexcept { return data_[i]; }
    const T& operator[](std::size_t i) const noexcept { return data_[i]; }
    T* begin() noexcept { return data(); }
    T* end() noexcept { return data() + size_; }
    const T* begin() const noexcept { return data(); }
    const T* end() const noexcept { return data() + size_; }

    /// Says that only the first `size` elements are meant; the memory stays.
    void shrink(std::size_t size) noexcept { size_ = size; }

    void release() noexcept {
        data_.reset();
        size_ = 0;
    }

    /// Hands the memory over to an Array, without a copy.
    Array to_array(std::size_t components = 1) && {
        std::shared_ptr<const T[]> owner = std::move(data_);
        const T* first = owner.get();
        return Array(scalar_type_of<T>(), first, std::exchange(size_, 0) / components, components, std::move(owner));
    }

private:
    struct GiveBack {
        std::size_t bytes = 0;
        void operator()(T* data) const noexcept { give_back({data, bytes}); }
    };

    std::unique_ptr<T[], GiveBack> data_;
    std::size_t size_ = 0;
};

} // namespace isotet::core
