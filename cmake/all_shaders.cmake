# isotet_all_shaders(TARGET): every shader of the project, found by looking, as vulkan::all_shaders of all_shaders.hpp; and the
# list of pipelines made of them. For what compiles them without a device: bench/kernels and tests/vulkan.
function(isotet_all_shaders target)
    file(GLOB shaders CONFIGURE_DEPENDS
        ${PROJECT_SOURCE_DIR}/src/vulkan/kernels/*.comp
        ${PROJECT_SOURCE_DIR}/src/render/kernels/*.comp ${PROJECT_SOURCE_DIR}/src/render/kernels/*.frag
        ${PROJECT_SOURCE_DIR}/src/render/kernels/*.mesh ${PROJECT_SOURCE_DIR}/src/render/kernels/*.vert)
    set(relative "")
    foreach(shader ${shaders})
        file(RELATIVE_PATH path ${CMAKE_CURRENT_SOURCE_DIR} ${shader})
        list(APPEND relative ${path})
    endforeach()
    isotet_shaders(${target} all_shaders.hpp all_shaders ${relative})
    target_sources(${target} PRIVATE
        ${PROJECT_SOURCE_DIR}/bench/kernels/null_device.cpp
        ${PROJECT_SOURCE_DIR}/bench/kernels/pipelines.cpp)
    target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/src ${ISOTET_VULKAN_HEADERS})
endfunction()

# The program isotet_device_kernels, once: for the benchmarks' tables and for the tests.
function(isotet_device_kernels)
    if(TARGET isotet_device_kernels)
        return()
    endif()
    add_executable(isotet_device_kernels ${PROJECT_SOURCE_DIR}/bench/kernels/device_kernels.cpp)
    isotet_target(isotet_device_kernels)
    isotet_all_shaders(isotet_device_kernels)
    target_link_libraries(isotet_device_kernels PRIVATE isotet_vulkan fmt::fmt ${CMAKE_DL_LIBS})
endfunction()
