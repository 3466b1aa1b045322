// Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
#include "vulkan/failing_calls.hpp"

#include <string_view>
#include <type_traits>

namespace isotet::test {

namespace {

CallPlan* current_plan = nullptr;

bool fails(const char* name) {
    CallPlan& plan = *current_plan;
    if (!plan.only.empty() && plan.only != name) return false;
    plan.calls.emplace_back(name);
    return static_cast<int>(plan.calls.size()) == plan.fail_at;
}

/// Stands for one function of the table; `Name` is a type that tells its name.
template <class Name, class Function>
struct Standin;

template <class Name, class... Arguments>
struct Standin<Name, VkResult(VKAPI_PTR*)(Arguments...)> {
    static inline VkResult(VKAPI_PTR* original)(Arguments...) = nullptr;
    static VKAPI_ATTR VkResult VKAPI_CALL call(Arguments... arguments) {
        if (!fails(Name::text)) return original(arguments...);
        // The work of a device that is really lost has ended; here it still has to, before its objects go.
        if (std::string_view(Name::text) == "vkWaitForFences") original(arguments...);
        return current_plan->with;
    }
};

template <class Name, class Function>
void replace(Function& function) {
    if constexpr (requires { Standin<Name, Function>::call; }) {
        Standin<Name, Function>::original = function;
        function = &Standin<Name, Function>::call;
    }
}

#define ISOTET_NAME(name)                                                                                              \
    struct NameOf_##name {                                                                                             \
        static constexpr const char* text = #name;                                                                     \
    };
ISOTET_VULKAN_DEVICE_FUNCTIONS(ISOTET_NAME)
#undef ISOTET_NAME

} // namespace

void make_calls_follow(CallPlan& plan, vulkan::DeviceFunctions& functions) {
    current_plan = &plan;
#define ISOTET_REPLACE(name) replace<NameOf_##name>(functions.name);
    ISOTET_VULKAN_DEVICE_FUNCTIONS(ISOTET_REPLACE)
#undef ISOTET_REPLACE
}

} // namespace isotet::test
