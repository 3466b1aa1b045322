// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "vulkan/pipeline_cache.hpp"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <unistd.h>

#include <isotet/version.hpp>

namespace isotet::vulkan {

namespace {

namespace fs = std::filesystem;

/// What a file begins with.
struct Head {
    char magic[8];
    std::uint64_t bytes; ///< that follow
    std::uint64_t hash;  ///< of them
};
constexpr char magic[8] = {'i', 's', 'o', 't', 'e', 't', 'P', '1'};

/// Larger files are not ours.
constexpr std::uint64_t max_bytes = std::uint64_t{256} << 20;

/// FNV-1a: not against enemies (who could write into the folder as well), against broken disks and cut files.
class Hash {
public:
    void add(std::span<const std::byte> bytes) {
        for (const std::byte byte : bytes) value_ = (value_ ^ static_cast<std::uint64_t>(byte)) * 0x100000001b3u;
    }
    template <class T>
    void add_value(const T& value) {
        add(std::as_bytes(std::span(&value, 1)));
    }
    std::uint64_t value() const noexcept { return value_; }

private:
    std::uint64_t value_ = 0xcbf29ce484222325u;
};

std::uint64_t hash_of(std::span<const std::byte> bytes) {
    Hash hash;
    hash.add(bytes);
    return hash.value();
}

/// Driver and build: what makes compiled pipelines the same.
std::uint64_t key_of(const Capabilities& capabilities) {
    Hash hash;
    const VkPhysicalDeviceProperties& properties = capabilities.properties;
    hash.add_value(properties.vendorID);
    hash.add_value(properties.deviceID);
    hash.add_value(properties.driverVersion);
    hash.add_value(properties.pipelineCacheUUID);
    for (const std::string_view build : {ISOTET_VERSION, ISOTET_COMMIT}) hash.add(std::as_bytes(std::span(build)));
    return hash.value();
}

/// What stands in the file behind a head that fits it; empty otherwise.
std::vector<std::byte> read_checked(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    Head head{};
    if (!file.read(reinterpret_cast<char*>(&head), sizeof head)) return {};
    std::error_code failed;
    const std::uintmax_t size = fs::file_size(path, failed);
    if (failed || std::memcmp(head.magic, magic, sizeof magic) != 0 || head.bytes > max_bytes ||
        size != sizeof head + head.bytes)
        return {};
    std::vector<std::byte> bytes(head.bytes);
    if (!file.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()))) return {};
    if (hash_of(bytes) != head.hash) return {};
    return bytes;
}

constexpr std::string_view prefix = "pipelines-", suffix = ".bin", tested_suffix = PipelineCache::tested_suffix;

/// Removes the files of other builds and drivers that were written longest ago, with their notes, and what writers that were
/// killed left. Other files are left alone.
void tidy(const fs::path& folder) {
    using Written = std::pair<fs::file_time_type, fs::path>;
    const auto hour_ago = fs::file_time_type::clock::now() - std::chrono::hours(1);
    std::vector<Written> files;
    std::error_code failed;
    for (fs::directory_iterator entry(folder, failed), end; !failed && entry != end; entry.increment(failed)) {
        const std::string name = entry->path().filename().string();
        std::error_code gone; // by another process
        if (!name.starts_with(prefix) || !entry->is_regular_file(gone)) continue;
        const fs::file_time_type written = entry->last_write_time(gone);
        if (gone) continue;
        if (name.ends_with(suffix)) files.emplace_back(written, entry->path());
        else if (name.find(fmt::format("{}.", suffix)) != name.npos && !name.ends_with(tested_suffix) &&
                 written < hour_ago)
            fs::remove(entry->path(), gone);
    }
    std::ranges::sort(files, std::greater());
    for (std::size_t i = PipelineCache::max_files; i < files.size(); ++i) {
        fs::remove(files[i].second, failed);
        fs::remove(files[i].second.concat(tested_suffix), failed);
    }
}

} // namespace

PipelineCache::PipelineCache(LogicalDevice& device, const Capabilities& capabilities, const fs::path& folder)
    : device_(device) {
    std::vector<std::byte> bytes;
    if (!folder.empty()) {
        file_ = folder / fmt::format("{}{:016x}{}", prefix, key_of(capabilities), suffix);
        bytes = read_checked(file_);
    }
    VkPipelineCacheCreateInfo create{};
    create.sType = VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO;
    create.initialDataSize = bytes.size();
    create.pInitialData = bytes.data();
    const DeviceFunctions& call = device_.call();
    VkResult made = call.vkCreatePipelineCache(device_.handle(), &create, nullptr, &handle_);
    bytes_read_ = made == VK_SUCCESS ? bytes.size() : 0;
    if (made != VK_SUCCESS && !bytes.empty()) {
        create.initialDataSize = 0;
        made = call.vkCreatePipelineCache(device_.handle(), &create, nullptr, &handle_);
    }
    if (made != VK_SUCCESS) handle_ = VK_NULL_HANDLE; // kernels are built without
}

PipelineCache::~PipelineCache() {
    if (!handle_ || device_.hung()) return;
    if (changed_ && !file_.empty() && device_.alive()) save();
    device_.call().vkDestroyPipelineCache(device_.handle(), handle_, nullptr);
}

void PipelineCache::save() const {
    const DeviceFunctions& call = device_.call();
    std::size_t size = 0;
    if (call.vkGetPipelineCacheData(device_.handle(), handle_, &size, nullptr) != VK_SUCCESS || size > max_bytes)
        return;
    std::vector<std::byte> bytes(size);
    if (call.vkGetPipelineCacheData(device_.handle(), handle_, &size, bytes.data()) != VK_SUCCESS) return;
    bytes.resize(size);
    Head head{};
    std::memcpy(head.magic, magic, sizeof magic);
    head.bytes = bytes.size();
    head.hash = hash_of(bytes);

    // Written beside and renamed, so that a reader sees the old file or the new one.
    std::error_code failed;
    fs::create_directories(file_.parent_path(), failed);
    const fs::path beside = fs::path(file_).concat(fmt::format(".{}", getpid()));
    std::ofstream file(beside, std::ios::binary | std::ios::trunc);
    file.write(reinterpret_cast<const char*>(&head), sizeof head);
    file.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    file.close();
    if (file) fs::rename(beside, file_, failed);
    if (!file || failed) fs::remove(beside, failed);
    tidy(file_.parent_path());
}

} // namespace isotet::vulkan
