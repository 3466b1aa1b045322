// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "vulkan/devices/instance.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include <fmt/core.h>

#include "vulkan/devices/failure.hpp"
#include "vulkan/devices/loader.hpp"

namespace isotet::vulkan {

namespace {

constexpr const char* validation_layer = "VK_LAYER_KHRONOS_validation";

bool has_extension(const LoaderFunctions& call, const char* layer, std::string_view name) {
    std::uint32_t count = 0;
    if (call.vkEnumerateInstanceExtensionProperties(layer, &count, nullptr) != VK_SUCCESS) return false;
    std::vector<VkExtensionProperties> found(count);
    if (call.vkEnumerateInstanceExtensionProperties(layer, &count, found.data()) < VK_SUCCESS) return false;
    return std::any_of(found.begin(), found.end(), [&](const auto& one) { return one.extensionName == name; });
}

bool has_validation_layer(const LoaderFunctions& call) {
    std::uint32_t count = 0;
    if (call.vkEnumerateInstanceLayerProperties(&count, nullptr) != VK_SUCCESS) return false;
    std::vector<VkLayerProperties> found(count);
    if (call.vkEnumerateInstanceLayerProperties(&count, found.data()) < VK_SUCCESS) return false;
    return std::any_of(found.begin(), found.end(),
                       [](const auto& one) { return std::string_view(one.layerName) == validation_layer; });
}

VKAPI_ATTR VkBool32 VKAPI_CALL hear(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                                    const VkDebugUtilsMessengerCallbackDataEXT* data, void* complaints) {
    static_cast<Complaints*>(complaints)->add(data->pMessage ? data->pMessage : "");
    return VK_FALSE;
}

/// Always the machine's fault: loaders speak of memory, too, when a driver's description is broken.
Error no_instance(VkResult result) {
    if (result == VK_ERROR_INCOMPATIBLE_DRIVER)
        return {ErrorCode::no_device,
                "there is a Vulkan loader on this machine, but no driver that it can use; drivers of graphics cards "
                "bring one, and the package mesa-vulkan-drivers of Debian and Ubuntu has a software device"};
    return {ErrorCode::no_device, failure("starting Vulkan", result).message};
}

} // namespace

Result<std::unique_ptr<Instance>> Instance::open(const Watch& watch, std::uint32_t version) {
    const Validation validation = watch.validation;
    const Result<LoaderFunctions> found = loader();
    if (!found) return found.error();
    const LoaderFunctions& load = *found;

    std::uint32_t of_loader = VK_API_VERSION_1_0;
    if (const VkResult asked = load.vkEnumerateInstanceVersion(&of_loader); asked != VK_SUCCESS)
        return no_instance(asked);
    if (of_loader < VK_API_VERSION_1_2) {
        return Error{ErrorCode::no_device,
                     fmt::format("the Vulkan loader is of version {}.{}, but 1.2 is needed",
                                 VK_API_VERSION_MAJOR(of_loader), VK_API_VERSION_MINOR(of_loader))};
    }
    if (validation != Validation::off && !has_validation_layer(load))
        return Error{ErrorCode::no_device, fmt::format("the layer {} is not installed", validation_layer)};

    std::unique_ptr<Instance> instance(new Instance);
    instance->watch_ = watch;
    const bool naming = has_extension(load, nullptr, VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    std::vector<const char*> extensions;
    if (naming) extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);

    VkApplicationInfo application{};
    application.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO;
    application.pApplicationName = "isotet";
    application.pEngineName = "isotet";
    application.apiVersion = version;

    VkDebugUtilsMessengerCreateInfoEXT messages{};
    messages.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT;
    messages.messageSeverity =
        VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    messages.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
    messages.pfnUserCallback = &hear;
    messages.pUserData = watch.complaints.get();

    const std::array<VkValidationFeatureEnableEXT, 2> assisted = {
        VK_VALIDATION_FEATURE_ENABLE_GPU_ASSISTED_EXT,
        VK_VALIDATION_FEATURE_ENABLE_GPU_ASSISTED_RESERVE_BINDING_SLOT_EXT};
    const VkValidationFeatureEnableEXT synchronization = VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT;
    VkValidationFeaturesEXT features{};
    features.sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT;
    features.pNext = naming ? &messages : nullptr; // so that making the instance is watched, too
    const bool on_device = validation == Validation::gpu_assisted;
    features.enabledValidationFeatureCount = on_device ? 2 : 1;
    features.pEnabledValidationFeatures = on_device ? assisted.data() : &synchronization;

    VkInstanceCreateInfo create{};
    create.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
    create.pApplicationInfo = &application;
    create.enabledExtensionCount = static_cast<std::uint32_t>(extensions.size());
    create.ppEnabledExtensionNames = extensions.data();
    if (validation != Validation::off) {
        create.pNext = &features;
        create.enabledLayerCount = 1;
        create.ppEnabledLayerNames = &validation_layer;
    }
    if (const VkResult made = load.vkCreateInstance(&create, nullptr, &instance->handle_); made != VK_SUCCESS) {
        instance->handle_ = VK_NULL_HANDLE;
        return no_instance(made);
    }

    if (Result<void> loaded = instance->load(load.vkGetInstanceProcAddr, naming); !loaded) return loaded.error();
    const InstanceFunctions& call = instance->call_;
    if (validation != Validation::off && call.vkCreateDebugUtilsMessengerEXT) {
        const VkResult made =
            call.vkCreateDebugUtilsMessengerEXT(instance->handle_, &messages, nullptr, &instance->messenger_);
        if (made != VK_SUCCESS) return failure("listening to the validation layer", made);
    }
    return instance;
}

Result<std::unique_ptr<Instance>> Instance::adopt(const VulkanHandles& handles) {
    auto get = reinterpret_cast<PFN_vkGetInstanceProcAddr>(handles.get_instance_proc_addr);
    if (!get) {
        const Result<LoaderFunctions> found = loader();
        if (!found) return found.error();
        get = found->vkGetInstanceProcAddr;
    }
    std::unique_ptr<Instance> instance(new Instance);
    instance->owned_ = false;
    instance->handle_ = static_cast<VkInstance>(handles.instance);
    if (Result<void> loaded = instance->load(get, false); !loaded) return loaded.error();
    return instance;
}

Result<void> Instance::load(PFN_vkGetInstanceProcAddr get, bool naming) {
#define ISOTET_LOAD(name) call_.name = reinterpret_cast<PFN_##name>(get(handle_, #name));
    ISOTET_VULKAN_INSTANCE_FUNCTIONS(ISOTET_LOAD)
    if (naming) {
        ISOTET_VULKAN_DEBUG_FUNCTIONS(ISOTET_LOAD)
    }
#undef ISOTET_LOAD
#define ISOTET_CHECK(name)                                                                                             \
    if (!call_.name) return Error{ErrorCode::no_device, "the Vulkan loader lacks " #name};
    ISOTET_VULKAN_INSTANCE_FUNCTIONS(ISOTET_CHECK)
#undef ISOTET_CHECK
    return {};
}

Instance::~Instance() {
    if (!owned_) return;
    if (messenger_) call_.vkDestroyDebugUtilsMessengerEXT(handle_, messenger_, nullptr);
    if (handle_ && call_.vkDestroyInstance) call_.vkDestroyInstance(handle_, nullptr);
}

Result<std::vector<VkPhysicalDevice>> Instance::devices() const {
    // The number may change between the two calls: then once more.
    for (;;) {
        std::uint32_t count = 0;
        VkResult asked = call_.vkEnumeratePhysicalDevices(handle_, &count, nullptr);
        std::vector<VkPhysicalDevice> found(count);
        if (asked == VK_SUCCESS) asked = call_.vkEnumeratePhysicalDevices(handle_, &count, found.data());
        if (asked == VK_INCOMPLETE) continue;
        if (asked == VK_ERROR_INCOMPATIBLE_DRIVER) return std::vector<VkPhysicalDevice>();
        if (asked != VK_SUCCESS) return failure("listing the Vulkan devices", asked);
        found.resize(count);
        return found;
    }
}

} // namespace isotet::vulkan
