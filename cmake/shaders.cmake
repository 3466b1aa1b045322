# Shaders are compiled when isotet is built and stand in the library as numbers: no file is looked for at run time.

if(ISOTET_VULKAN)
    find_program(ISOTET_GLSLC glslc)
    find_path(ISOTET_VULKAN_HEADERS vulkan/vulkan_core.h)
    if(NOT ISOTET_GLSLC OR NOT ISOTET_VULKAN_HEADERS)
        message(FATAL_ERROR "The Vulkan engine needs the compiler glslc and Vulkan's headers (Debian: glslc, libvulkan-dev). "
                            "Install them, or configure with -DISOTET_VULKAN=OFF")
    endif()
endif()

# isotet_shaders(TARGET HEADER NAMESPACE shader.comp ...): compiles shaders into `target`, whose files can then include
# HEADER and find each as NAMESPACE::shader, a ShaderCode. Files may include what lies beside them and in src/vulkan/kernels.
function(isotet_shaders target header namespace)
    set(folder ${CMAKE_CURRENT_BINARY_DIR}/shaders)
    set(declarations "")
    set(definitions "")
    set(numbers "")
    set(all "")
    foreach(source ${ARGN})
        get_filename_component(name ${source} NAME_WE)
        # Devices of Vulkan 1.1 take them; mesh shaders are not for these.
        set(version 1.1)
        if(source MATCHES "[.]mesh$")
            set(version 1.2)
        endif()
        set(words ${folder}/${name}.inc)
        add_custom_command(OUTPUT ${words}
            COMMAND ${ISOTET_GLSLC} --target-env=vulkan${version} -Werror -I ${PROJECT_SOURCE_DIR}/src/vulkan/kernels
                    -mfmt=num -MD -MF ${words}.d -MT ${words} -o ${words} ${CMAKE_CURRENT_SOURCE_DIR}/${source}
            DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${source} DEPFILE ${words}.d VERBATIM COMMENT "Compiling shader ${name}")
        list(APPEND numbers ${words})
        string(APPEND declarations "extern const ShaderCode ${name};\n")
        string(APPEND all "&${name}, ")
        string(APPEND definitions "static const std::uint32_t words_of_${name}[] = {\n#include \"${words}\"\n};\n"
                                  "const ShaderCode ${name}{\"${name}\", words_of_${name}};\n")
    endforeach()
    file(CONFIGURE OUTPUT ${folder}/${header} CONTENT
"// Written by cmake/shaders.cmake.
#pragma once

#include \"vulkan/shader_code.hpp\"

namespace isotet::vulkan::${namespace} {
${declarations}
inline const ShaderCode* const every[] = {${all}};
} // namespace isotet::vulkan::${namespace}
")
    string(MAKE_C_IDENTIFIER ${header} file)
    file(CONFIGURE OUTPUT ${folder}/${file}.cpp CONTENT
"// Written by cmake/shaders.cmake.
#include \"${header}\"

namespace isotet::vulkan::${namespace} {
${definitions}} // namespace isotet::vulkan::${namespace}
")
    add_custom_target(${target}_${file} DEPENDS ${numbers})
    add_dependencies(${target} ${target}_${file})
    target_sources(${target} PRIVATE ${folder}/${file}.cpp)
    target_include_directories(${target} PRIVATE ${folder})
endfunction()
