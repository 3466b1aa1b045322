# find_package(isotet COMPONENTS ...) and pkg-config for installed copies; add_subdirectory() gives the same target names.

set(ISOTET_COMPONENTS isotet vulkan render io)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/isotet)

# A set of targets a component, so that one can be found without what another needs.
foreach(component ${ISOTET_COMPONENTS})
    set(target isotet_${component})
    if(component STREQUAL "isotet")
        set(target isotet)
    endif()
    install(TARGETS ${target} EXPORT isotet-${component}
        LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
    set_target_properties(${target} PROPERTIES INSTALL_RPATH $ORIGIN)
    install(EXPORT isotet-${component} NAMESPACE isotet:: DESTINATION ${package_dir} FILE isotet-${component}.cmake)
endforeach()

if(TARGET isotet_reader)
    install(TARGETS isotet_reader EXPORT isotet-io RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT program)
endif()

# What belongs to isotet_extras and isotet_jobs, which are not installed, stays here.
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/isotet DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
    FILES_MATCHING PATTERN "*.hpp" PATTERN "*.h"
    PATTERN jobs EXCLUDE PATTERN paper EXCLUDE PATTERN text.hpp EXCLUDE PATTERN isosurface_scene.hpp EXCLUDE)
install(FILES ${PROJECT_BINARY_DIR}/include/isotet/version.hpp DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/isotet)

configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/isotet-config.cmake.in ${PROJECT_BINARY_DIR}/isotet-config.cmake
    INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/isotet-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/isotet-config.cmake ${PROJECT_BINARY_DIR}/isotet-config-version.cmake
    ${PROJECT_SOURCE_DIR}/cmake/FindCompressors.cmake ${PROJECT_SOURCE_DIR}/cmake/FindWebP.cmake
    DESTINATION ${package_dir})

# pkg-config: what only a static library needs stands under .private.
function(isotet_pkg_config name description requires requires_private libs_private)
    file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/${name}.pc CONTENT
"prefix=\${pcfiledir}/@pc_to_prefix@
includedir=\${prefix}/@CMAKE_INSTALL_INCLUDEDIR@
libdir=\${prefix}/@CMAKE_INSTALL_LIBDIR@

Name: ${name}
Description: ${description}
Version: @PROJECT_VERSION@
Requires: ${requires}
Requires.private: ${requires_private}
Cflags: -I\${includedir} -std=c++20
Libs: -L\${libdir} -l@library@
Libs.private: ${libs_private}
" @ONLY)
    install(FILES ${PROJECT_BINARY_DIR}/${name}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
endfunction()
file(RELATIVE_PATH pc_to_prefix /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
string(REGEX REPLACE "/$" "" pc_to_prefix "${pc_to_prefix}")
set(library isotet)
isotet_pkg_config(isotet "Isosurfaces of large unstructured grids" "" "tbb fmt" "-lmeshoptimizer -lpthread")
set(library isotet_vulkan)
isotet_pkg_config(isotet-vulkan "Isosurfaces on Vulkan devices" isotet fmt "-ldl")
set(library isotet_render)
isotet_pkg_config(isotet-render "Pictures of isosurfaces" isotet-vulkan "fmt freetype2" "")
set(library isotet_io)
isotet_pkg_config(isotet-io "Grids and surfaces in files" isotet "fmt libpng libwebpmux libwebp libdeflate liblz4 liblzma pugixml" "")

install(FILES ${PROJECT_SOURCE_DIR}/LICENSE ${PROJECT_SOURCE_DIR}/README.md ${PROJECT_SOURCE_DIR}/CHANGELOG.md
    DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program OPTIONAL)
