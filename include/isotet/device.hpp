// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <isotet/export.hpp>
#include <isotet/result.hpp>

namespace isotet {

namespace vulkan {
class Context;
}

enum class DeviceKind : std::uint8_t { discrete, integrated, virtual_gpu, software, other };

/// "discrete GPU", "integrated GPU", "virtual GPU", "software", "other".
ISOTET_API std::string_view name_of(DeviceKind kind) noexcept;

/// A Vulkan device, as its driver describes it.
struct DeviceInfo {
    std::size_t index = 0; ///< its place in list_devices(), which a choice may name
    std::string name;      ///< "NVIDIA GeForce RTX 4070"
    DeviceKind kind = DeviceKind::other;
    std::string driver;             ///< name and version: "NVIDIA 550.54.14"
    std::string api;                ///< Vulkan version: "1.3.277"
    std::uint64_t memory = 0;       ///< bytes of the device's own memory (of the machine's, where they are one)
    std::uint64_t memory_free = 0;  ///< of these, what this process can still take; all of `memory` where the driver
                                    ///< does not tell
    bool memory_free_known = false; ///< the driver tells (VK_EXT_memory_budget)
    bool unified_memory = false;    ///< the processor reads and writes the device's memory directly
    bool transfer_queue = false;    ///< copies to and from the device have a queue of their own
    bool timestamps = false;        ///< times of passes can be measured
    std::uint64_t allocation_limit = 0;           ///< bytes of the largest buffer
    std::array<std::uint32_t, 3> workgroups = {}; ///< most workgroups of one dispatch, an axis
    std::uint32_t workgroup_size = 0;             ///< most invocations of a workgroup
    std::uint32_t shared_memory = 0;              ///< bytes a workgroup
    std::uint32_t subgroup_size = 0;
    std::string unusable; ///< why isotet cannot use it, a sentence; empty: it can
};

/// What there is on this machine.
struct DeviceList {
    std::vector<DeviceInfo> devices; ///< in the driver's order, unusable ones too
    std::optional<std::size_t> best; ///< the one that Device::open() takes without a choice, if there is one
    std::string unavailable;         ///< why there is no Vulkan at all, a sentence; empty: there is
};

/// Looks for Vulkan devices. Opens the Vulkan loader (libvulkan.so.1) at run time: without it, or without a driver,
/// `unavailable` says so.
///
/// Cost      about 50 ms
/// Errors    out_of_memory; no Vulkan and no device are none
/// Threads   safe from many threads
ISOTET_API Result<DeviceList> list_devices();

struct DeviceOptions {
    /// "": the best real GPU that can be used (discrete before integrated before virtual, then the most memory), never
    /// a software device. "software": the software device. A number: the index in list_devices(). Else a part of a
    /// name, in small or capital letters, that fits one device only.
    std::string choice;
    std::uint64_t memory_limit = 0; ///< bytes of device memory that buffers may take in all; 0: what the driver says is
                                    ///< free
};

/// A device that is ready to work. Copies share it.
///
/// Threads   one operation at a time on one device; different devices are independent
class ISOTET_API Device {
public:
    /// Opens a device and tests its arithmetic on the device itself, and its kernels on two small grids against the CPU engine
    /// (docs/inside/gpu.md).
    ///
    /// Cost      100 ms to a second, mostly the driver's; compiled kernels are kept in XDG_CACHE_HOME/isotet
    /// Errors    invalid_argument when no device, or more than one, fits the choice; no_device when there is no Vulkan,
    ///           no GPU, or when the device cannot be used, with the reason; also when its driver builds wrong kernels
    static Result<Device> open(const DeviceOptions& options = {});

    /// A device that was opened with settings of its own, by tests.
    explicit Device(std::shared_ptr<vulkan::Context> context) : context_(std::move(context)) {}
    Device(const Device&) = default; // no move: a device that was moved from stays what it was
    Device& operator=(const Device&) = default;
    ~Device() = default;

    const DeviceInfo& info() const noexcept;

    /// What the user should know: that the device failed the arithmetic test, so that bytes may differ from the CPU's.
    const std::vector<std::string>& notices() const noexcept;

    std::uint64_t memory_used() const; ///< bytes of device memory that buffers take now
    std::uint64_t memory_free() const; ///< bytes that can still be taken, within the limit

    const std::shared_ptr<vulkan::Context>& context() const noexcept { return context_; }

private:
    std::shared_ptr<vulkan::Context> context_;
};

} // namespace isotet
