// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
// Vulkan's types, and every Vulkan function that isotet calls. Nothing is linked: the loader is opened at run time, and
// functions are asked for by name. Tables instead of global pointers: a program that links isotet may link Vulkan too.
#pragma once

#ifndef VK_NO_PROTOTYPES
#define VK_NO_PROTOTYPES
#endif
#include <vulkan/vulkan_core.h>

namespace isotet::vulkan {

// Of the loader, before there is an instance.
#define ISOTET_VULKAN_LOADER_FUNCTIONS(X) \
    X(vkCreateInstance)                   \
    X(vkEnumerateInstanceExtensionProperties) \
    X(vkEnumerateInstanceLayerProperties) \
    X(vkEnumerateInstanceVersion)

// Of an instance.
#define ISOTET_VULKAN_INSTANCE_FUNCTIONS(X)   \
    X(vkCreateDevice)                         \
    X(vkDestroyInstance)                      \
    X(vkEnumerateDeviceExtensionProperties)   \
    X(vkEnumeratePhysicalDevices)             \
    X(vkGetDeviceProcAddr)                    \
    X(vkGetPhysicalDeviceExternalBufferProperties) \
    X(vkGetPhysicalDeviceFeatures2)           \
    X(vkGetPhysicalDeviceMemoryProperties2)   \
    X(vkGetPhysicalDeviceProperties)          \
    X(vkGetPhysicalDeviceProperties2)         \
    X(vkGetPhysicalDeviceQueueFamilyProperties2)

// Of an instance with VK_EXT_debug_utils; null without it.
#define ISOTET_VULKAN_DEBUG_FUNCTIONS(X) \
    X(vkCreateDebugUtilsMessengerEXT)    \
    X(vkDestroyDebugUtilsMessengerEXT)

// Of a device.
#define ISOTET_VULKAN_DEVICE_FUNCTIONS(X) \
    X(vkAllocateCommandBuffers)           \
    X(vkAllocateMemory)                   \
    X(vkBeginCommandBuffer)               \
    X(vkBindBufferMemory)                 \
    X(vkBindImageMemory)                  \
    X(vkCmdBeginRenderPass)               \
    X(vkCmdBindIndexBuffer)               \
    X(vkCmdBindPipeline)                  \
    X(vkCmdCopyBuffer)                    \
    X(vkCmdCopyImageToBuffer)             \
    X(vkCmdDispatch)                      \
    X(vkCmdDispatchIndirect)              \
    X(vkCmdDraw)                          \
    X(vkCmdDrawIndexed)                   \
    X(vkCmdDrawIndexedIndirect)           \
    X(vkCmdDrawIndirect)                  \
    X(vkCmdEndRenderPass)                 \
    X(vkCmdFillBuffer)                    \
    X(vkCmdPipelineBarrier)               \
    X(vkCmdPushConstants)                 \
    X(vkCmdResetQueryPool)                \
    X(vkCmdSetScissor)                    \
    X(vkCmdSetViewport)                   \
    X(vkCmdUpdateBuffer)                  \
    X(vkCmdWriteTimestamp)                \
    X(vkCreateBuffer)                     \
    X(vkCreateCommandPool)                \
    X(vkCreateComputePipelines)           \
    X(vkCreateFence)                      \
    X(vkCreateFramebuffer)                \
    X(vkCreateGraphicsPipelines)          \
    X(vkCreateImage)                      \
    X(vkCreateImageView)                  \
    X(vkCreatePipelineCache)              \
    X(vkCreatePipelineLayout)             \
    X(vkCreateQueryPool)                  \
    X(vkCreateRenderPass)                 \
    X(vkCreateShaderModule)               \
    X(vkDestroyBuffer)                    \
    X(vkDestroyCommandPool)               \
    X(vkDestroyDevice)                    \
    X(vkDestroyFence)                     \
    X(vkDestroyFramebuffer)               \
    X(vkDestroyImage)                     \
    X(vkDestroyImageView)                 \
    X(vkDestroyPipeline)                  \
    X(vkDestroyPipelineCache)             \
    X(vkDestroyPipelineLayout)            \
    X(vkDestroyQueryPool)                 \
    X(vkDestroyRenderPass)                \
    X(vkDestroyShaderModule)              \
    X(vkEndCommandBuffer)                 \
    X(vkFreeMemory)                       \
    X(vkGetBufferDeviceAddress)           \
    X(vkGetBufferMemoryRequirements)      \
    X(vkGetDeviceQueue)                   \
    X(vkGetFenceStatus)                   \
    X(vkGetImageMemoryRequirements)       \
    X(vkGetPipelineCacheData)             \
    X(vkGetQueryPoolResults)              \
    X(vkMapMemory)                        \
    X(vkQueueSubmit)                      \
    X(vkResetCommandPool)                 \
    X(vkResetFences)                      \
    X(vkWaitForFences)

// Of a device with VK_EXT_mesh_shader; null without it.
#define ISOTET_VULKAN_MESH_FUNCTIONS(X) \
    X(vkCmdDrawMeshTasksEXT)

// Of a device with VK_KHR_external_memory_fd; null without it.
#define ISOTET_VULKAN_SHARING_FUNCTIONS(X) \
    X(vkGetMemoryFdKHR)

// Of a device with VK_EXT_debug_utils; null without it.
#define ISOTET_VULKAN_NAMING_FUNCTIONS(X) \
    X(vkSetDebugUtilsObjectNameEXT)       \
    X(vkCmdBeginDebugUtilsLabelEXT)       \
    X(vkCmdEndDebugUtilsLabelEXT)

#define ISOTET_VULKAN_MEMBER(name) PFN_##name name = nullptr;

struct LoaderFunctions {
    PFN_vkGetInstanceProcAddr vkGetInstanceProcAddr = nullptr;
    ISOTET_VULKAN_LOADER_FUNCTIONS(ISOTET_VULKAN_MEMBER)
};

struct InstanceFunctions {
    ISOTET_VULKAN_INSTANCE_FUNCTIONS(ISOTET_VULKAN_MEMBER)
    ISOTET_VULKAN_DEBUG_FUNCTIONS(ISOTET_VULKAN_MEMBER)
};

struct DeviceFunctions {
    ISOTET_VULKAN_DEVICE_FUNCTIONS(ISOTET_VULKAN_MEMBER)
    ISOTET_VULKAN_MESH_FUNCTIONS(ISOTET_VULKAN_MEMBER)
    ISOTET_VULKAN_SHARING_FUNCTIONS(ISOTET_VULKAN_MEMBER)
    ISOTET_VULKAN_NAMING_FUNCTIONS(ISOTET_VULKAN_MEMBER)
};

#undef ISOTET_VULKAN_MEMBER

} // namespace isotet::vulkan
