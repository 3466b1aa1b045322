# find_package(isotet) for installed copies; add_subdirectory() gives the same target names.

install(TARGETS isotet isotet_io EXPORT isotet-targets
    LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/isotet DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.hpp")
install(FILES ${PROJECT_BINARY_DIR}/include/isotet/version.hpp DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/isotet)
install(EXPORT isotet-targets NAMESPACE isotet:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/isotet)

configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/isotet-config.cmake.in ${PROJECT_BINARY_DIR}/isotet-config.cmake
    INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/isotet)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/isotet-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/isotet-config.cmake ${PROJECT_BINARY_DIR}/isotet-config-version.cmake
    ${PROJECT_SOURCE_DIR}/cmake/FindCompressors.cmake ${PROJECT_SOURCE_DIR}/cmake/FindWebP.cmake
    DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/isotet)
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE ${PROJECT_SOURCE_DIR}/README.md ${PROJECT_SOURCE_DIR}/CHANGELOG.md
    DESTINATION ${CMAKE_INSTALL_DOCDIR} OPTIONAL)
