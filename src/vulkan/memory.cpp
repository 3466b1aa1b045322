// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "vulkan/memory.hpp"

#include <algorithm>
#include <bit>
#include <optional>

#include <fmt/core.h>

#include "base/system/memory.hpp"
#include "vulkan/devices/failure.hpp"

namespace isotet::vulkan {

namespace {

constexpr std::uint64_t largest_block = std::uint64_t{64} << 20;
constexpr std::uint64_t smallest_block = std::uint64_t{1} << 20;

/// What buffers begin at a multiple of, and their bytes are counted in.
constexpr std::uint64_t grain = 256;

std::uint64_t round_up(std::uint64_t bytes, std::uint64_t multiple) {
    return (bytes + multiple - 1) / multiple * multiple;
}

} // namespace

Buffer::~Buffer() {
    if (memory_) memory_->give_back(*this);
}

void Buffer::swap(Buffer& other) noexcept {
    std::swap(memory_, other.memory_);
    std::swap(pool_, other.pool_);
    std::swap(block_, other.block_);
    std::swap(begin_, other.begin_);
    std::swap(taken_, other.taken_);
    std::swap(handle_, other.handle_);
    std::swap(address_, other.address_);
    std::swap(size_, other.size_);
    std::swap(mapped_, other.mapped_);
    std::swap(cached_, other.cached_);
}

Memory::Memory(LogicalDevice& device, const Capabilities& capabilities, std::uint64_t limit)
    : device_(device), limit_(limit), largest_(capabilities.largest_allocation), budget_(capabilities.memory_budget) {}

Result<std::unique_ptr<Memory>> Memory::open(LogicalDevice& device, const Capabilities& capabilities,
                                             const Options& options) {
    std::unique_ptr<Memory> memory(new Memory(device, capabilities, options.limit));
    memory->share_ = options.share;
    if (Result<void> chosen = memory->choose_types(capabilities, options); !chosen) return chosen.error();
    return memory;
}

Result<MemoryTypes> Memory::allowed_types(Where where) {
    Buffer probe; // all buffers there have its usage, and so may lie in the same memory types
    probe.size_ = grain;
    if (Result<void> made = make_buffer(probe, grain, where, "probe"); !made) return made.error();
    VkMemoryRequirements needs{};
    device_.call().vkGetBufferMemoryRequirements(device_.handle(), probe.handle_, &needs);
    device_.call().vkDestroyBuffer(device_.handle(), probe.handle_, nullptr);
    return needs.memoryTypeBits;
}

Result<void> Memory::choose_types(const Capabilities& capabilities, const Options& options) {
    const Result<MemoryTypes> allowed = allowed_types(Where::upload), on_device = allowed_types(Where::device);
    if (!allowed) return allowed.error();
    if (!on_device) return on_device.error();
    const VkPhysicalDeviceMemoryProperties& types = capabilities.memory;
    const auto set_up = [&](Where where, std::uint32_t type) {
        if (type == Capabilities::none) return false;
        Pool& pool = pool_of(where);
        const VkMemoryPropertyFlags flags = types.memoryTypes[type].propertyFlags;
        constexpr VkMemoryPropertyFlags for_mapping =
            VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
        pool.type = type;
        pool.mapped = (flags & for_mapping) == for_mapping;
        pool.cached = flags & VK_MEMORY_PROPERTY_HOST_CACHED_BIT;
        return true;
    };
    if (!set_up(Where::device, device_memory_type(capabilities, *on_device)) ||
        !set_up(Where::upload, upload_memory_type(capabilities, *allowed)) ||
        !set_up(Where::download, download_memory_type(capabilities, *allowed)))
        return Error{ErrorCode::no_device,
                     fmt::format("the driver allows buffers in the memory types {:#b} alone, and the processor can "
                                 "reach none of them",
                                 *allowed)};
    Pool& own = pool_of(Where::device);
    own.mapped = is_unified_type(capabilities, own.type) && !options.hide_unified;
    heap_ = types.memoryTypes[own.type].heapIndex;
    heap_bytes_ = types.memoryHeaps[heap_].size;

    const std::uint64_t most = limit_ ? std::min(limit_, heap_bytes_) : heap_bytes_;
    block_bytes_ = std::clamp(std::bit_floor(most / 16), smallest_block, largest_block);
    return {};
}

Memory::~Memory() {
    if (device_.hung()) return;
    for (Pool& pool : pools_)
        for (Block& block : pool.blocks) device_.call().vkFreeMemory(device_.handle(), block.memory, nullptr);
}

std::uint64_t Memory::cost(std::uint64_t bytes) noexcept {
    return round_up(std::max<std::uint64_t>(bytes, 1) + slack, grain);
}

std::uint64_t Memory::used() const {
    const std::lock_guard lock(mutex_);
    return used_;
}

std::uint64_t Memory::peak() const {
    const std::lock_guard lock(mutex_);
    return peak_;
}

std::uint64_t Memory::free() const {
    const std::lock_guard lock(mutex_);
    return free_locked();
}

std::uint64_t Memory::free_locked() const {
    const std::uint64_t outside = budget_ ? device_.free_memory(heap_) : heap_bytes_ - std::min(heap_bytes_, reserved_);
    const std::uint64_t there = outside + (reserved_ - used_);
    return limit_ ? std::min(there, limit_ - std::min(limit_, used_)) : there;
}

Result<Buffer> Memory::take(std::uint64_t bytes, Where where, std::string_view name) {
    const auto no_room = [&](std::string_view why) {
        return Error{ErrorCode::out_of_memory,
                     fmt::format("the device buffer '{}' needs {}, but {}", name, core::format_bytes(bytes), why)};
    };
    if (Result<void> lives = device_.alive(); !lives) return lives.error();
    if (bytes > largest_)
        return no_room(fmt::format("the largest that the device allows is {}", core::format_bytes(largest_)));

    const std::lock_guard lock(mutex_);
    if (where == Where::device) {
        if (const std::uint64_t free = free_locked(); cost(bytes) > free) {
            return no_room(fmt::format("{} are free{}", core::format_bytes(free),
                                       limit_ ? fmt::format(" of the {} allowed", core::format_bytes(limit_)) : ""));
        }
    }

    Buffer buffer;
    buffer.size_ = bytes;
    // Not rounded up any further, so that the validation layer sees kernels that leave the buffer.
    if (Result<void> made = make_buffer(buffer, round_up(std::max<std::uint64_t>(bytes, 1), 4) + slack, where, name);
        !made)
        return made.error();
    Pool& pool = pool_of(where);
    if (Result<void> placed = place(buffer, pool); !placed) {
        device_.call().vkDestroyBuffer(device_.handle(), buffer.handle_, nullptr);
        Error error = placed.error();
        error.message = fmt::format("the device buffer '{}' of {}: {}", name, core::format_bytes(bytes), error.message);
        return error;
    }
    buffer.memory_ = this; // from here on it gives itself back
    if (where == Where::device) {
        used_ += buffer.taken_;
        peak_ = std::max(peak_, used_);
    }
    VkBufferDeviceAddressInfo info{};
    info.sType = VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO;
    info.buffer = buffer.handle_;
    buffer.address_ = device_.call().vkGetBufferDeviceAddress(device_.handle(), &info);
    return buffer;
}

Result<void> Memory::make_buffer(Buffer& buffer, std::uint64_t bytes, Where where, std::string_view name) {
    const std::uint32_t families[] = {device_.compute().family, device_.transfer().family};
    VkBufferCreateInfo create{};
    create.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
    create.size = bytes;
    create.usage = buffer_usage;
    VkExternalMemoryBufferCreateInfo external{};
    external.sType = VK_STRUCTURE_TYPE_EXTERNAL_MEMORY_BUFFER_CREATE_INFO;
    external.handleTypes = VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT;
    if (share_ && where == Where::device) create.pNext = &external;
    if (device_.has_transfer_queue()) {
        create.sharingMode = VK_SHARING_MODE_CONCURRENT;
        create.queueFamilyIndexCount = 2;
        create.pQueueFamilyIndices = families;
    }
    if (const VkResult made = device_.call().vkCreateBuffer(device_.handle(), &create, nullptr, &buffer.handle_);
        made != VK_SUCCESS) {
        buffer.handle_ = VK_NULL_HANDLE;
        return failure(fmt::format("making the device buffer '{}' of {}", name, core::format_bytes(buffer.size_)),
                       made);
    }
    device_.name(VK_OBJECT_TYPE_BUFFER, buffer.handle_, name);
    return {};
}

Result<void> Memory::place(Buffer& buffer, Pool& pool) {
    VkMemoryRequirements needs{};
    device_.call().vkGetBufferMemoryRequirements(device_.handle(), buffer.handle_, &needs);
    if (!(needs.memoryTypeBits >> pool.type & 1))
        return Error{ErrorCode::no_device,
                     fmt::format("the driver does not allow buffers in memory type {}", pool.type)};
    const std::uint64_t alignment = std::max(needs.alignment, grain);
    const std::uint64_t bytes = round_up(needs.size, grain);

    Block* block = nullptr;
    std::optional<std::uint64_t> begin;
    // A buffer that would fill most of a block gets one of its own size.
    const bool alone = bytes > block_bytes_ / 2;
    for (auto one = pool.blocks.begin(); !alone && !begin && one != pool.blocks.end(); ++one) {
        begin = one->free.take(bytes, alignment);
        if (begin) block = &*one;
    }
    if (!begin) {
        // Near the end of the memory a whole block may not be had, but the buffer alone may.
        Result<Block*> made = new_block(pool, alone ? bytes : block_bytes_);
        if (!made && !alone && made.error().code == ErrorCode::out_of_memory) made = new_block(pool, bytes);
        if (!made) return made.error();
        block = *made;
        begin = block->free.take(bytes, alignment);
    }
    buffer.pool_ = &pool;
    buffer.block_ = block;
    buffer.begin_ = *begin;
    buffer.taken_ = bytes;
    if (const VkResult bound =
            device_.call().vkBindBufferMemory(device_.handle(), buffer.handle_, block->memory, *begin);
        bound != VK_SUCCESS) {
        give_back_range(buffer);
        return failure("binding it to memory", bound);
    }
    if (block->mapped) buffer.mapped_ = block->mapped + *begin;
    buffer.cached_ = pool.cached;
    return {};
}

Result<Block*> Memory::new_block(Pool& pool, std::uint64_t bytes) {
    const DeviceFunctions& call = device_.call();
    Block block(bytes);
    VkMemoryAllocateFlagsInfo flags{};
    flags.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO;
    flags.flags = VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT;
    VkExportMemoryAllocateInfo exported{};
    exported.sType = VK_STRUCTURE_TYPE_EXPORT_MEMORY_ALLOCATE_INFO;
    exported.handleTypes = VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT;
    if (share_ && &pool == &pool_of(Where::device)) flags.pNext = &exported;
    VkMemoryAllocateInfo allocate{};
    allocate.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
    allocate.pNext = &flags;
    allocate.allocationSize = bytes;
    allocate.memoryTypeIndex = pool.type;
    if (const VkResult made = call.vkAllocateMemory(device_.handle(), &allocate, nullptr, &block.memory);
        made != VK_SUCCESS)
        return failure(fmt::format("allocating {} on the device", core::format_bytes(bytes)), made);
    if (pool.mapped) {
        void* mapped = nullptr;
        if (const VkResult done = call.vkMapMemory(device_.handle(), block.memory, 0, VK_WHOLE_SIZE, 0, &mapped);
            done != VK_SUCCESS) {
            call.vkFreeMemory(device_.handle(), block.memory, nullptr);
            return failure("mapping memory of the device", done);
        }
        block.mapped = static_cast<std::byte*>(mapped);
    }
    if (&pool == &pool_of(Where::device)) reserved_ += bytes;
    pool.blocks.push_back(std::move(block));
    return &pool.blocks.back();
}

Result<Memory::Place> Memory::share(const Buffer& buffer) const {
    VkMemoryGetFdInfoKHR asked{};
    asked.sType = VK_STRUCTURE_TYPE_MEMORY_GET_FD_INFO_KHR;
    asked.memory = buffer.block_->memory;
    asked.handleType = VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT;
    Place place{-1, buffer.block_->free.size(), buffer.begin_, buffer.pool_->type};
    if (const VkResult got = device_.call().vkGetMemoryFdKHR(device_.handle(), &asked, &place.descriptor);
        got != VK_SUCCESS)
        return failure("exporting memory of the device", got);
    if (place.descriptor < 0)
        return Error{ErrorCode::device_failed, "exporting memory of the device: the driver gives no descriptor"};
    return place;
}

void Memory::give_back_range(const Buffer& buffer) noexcept {
    Block& block = *buffer.block_;
    block.free.give_back(buffer.begin_, buffer.taken_);
    if (!block.free.all_free()) return;
    Pool& pool = *buffer.pool_;
    if (&pool == &pool_of(Where::device)) reserved_ -= block.free.size();
    device_.call().vkFreeMemory(device_.handle(), block.memory, nullptr);
    pool.blocks.remove_if([&](const Block& one) { return &one == &block; });
}

void Memory::give_back(Buffer& buffer) noexcept {
    if (device_.hung()) return;
    const std::lock_guard lock(mutex_);
    device_.call().vkDestroyBuffer(device_.handle(), buffer.handle_, nullptr);
    if (buffer.pool_ == &pool_of(Where::device)) used_ -= buffer.taken_;
    give_back_range(buffer);
}

} // namespace isotet::vulkan
