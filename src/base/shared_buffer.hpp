// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// A Buffer that several owners share: copying shares the memory. Only its maker writes, before the first copy.
#pragma once

#include <cstddef>
#include <memory>
#include <utility>

#include "base/buffer.hpp"

namespace isotet::core {

template <class T>
class SharedBuffer {
public:
    SharedBuffer() = default;
    explicit SharedBuffer(std::size_t size) : size_(size) {
        auto buffer = std::make_shared<Buffer<T>>(size);
        data_ = std::shared_ptr<T>(buffer, buffer->data());
    }

    /// Shares memory of another kind.
    SharedBuffer(std::shared_ptr<T> data, std::size_t size) : data_(std::move(data)), size_(size) {}

    T* data() noexcept { return data_.get(); }
    const T* data() const noexcept { return data_.get(); }
    std::size_t size() const noexcept { return size_; }
    std::size_t bytes() const noexcept { return size_ * sizeof(T); }
    bool empty() const noexcept { return size_ == 0; }
    T& operator[](std::size_t i) noexcept { return data()[i]; }
    const T& operator[](std::size_t i) const noexcept { return data()[i]; }
    T* begin() noexcept { return data(); }
    T* end() noexcept { return data() + size_; }
    const T* begin() const noexcept { return data(); }
    const T* end() const noexcept { return data() + size_; }

    /// Hands the memory over to an Array, without a copy.
    Array to_array(std::size_t components = 1) && {
        const T* const first = data_.get();
        return Array(scalar_type_of<T>(), first, std::exchange(size_, 0) / components, components, std::move(data_));
    }

private:
    std::shared_ptr<T> data_;
    std::size_t size_ = 0;
};

} // namespace isotet::core
