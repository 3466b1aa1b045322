// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "vulkan/devices/loader.hpp"

#include <dlfcn.h>
#include <fmt/core.h>

namespace isotet::vulkan {

namespace {

Result<LoaderFunctions> open_loader() {
    void* library = dlopen("libvulkan.so.1", RTLD_NOW | RTLD_LOCAL);
    if (!library) {
        const char* why = dlerror();
        return Error{ErrorCode::no_device,
                     fmt::format("there is no Vulkan on this machine: {}", why ? why : "libvulkan.so.1")};
    }
    LoaderFunctions call;
    call.vkGetInstanceProcAddr = reinterpret_cast<PFN_vkGetInstanceProcAddr>(dlsym(library, "vkGetInstanceProcAddr"));
    bool complete = call.vkGetInstanceProcAddr != nullptr;
#define ISOTET_LOAD(name)                                                                                              \
    if (complete) call.name = reinterpret_cast<PFN_##name>(call.vkGetInstanceProcAddr(VK_NULL_HANDLE, #name));         \
    complete = complete && call.name;
    ISOTET_VULKAN_LOADER_FUNCTIONS(ISOTET_LOAD)
#undef ISOTET_LOAD
    // vkEnumerateInstanceVersion came with Vulkan 1.1.
    if (!complete)
        return Error{ErrorCode::no_device,
                     "the Vulkan loader libvulkan.so.1 is too old: it lacks the functions of Vulkan 1.1"};
    return call;
}

} // namespace

Result<LoaderFunctions> loader() {
    static const Result<LoaderFunctions> opened = open_loader();
    return opened;
}

} // namespace isotet::vulkan
