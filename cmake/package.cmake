# `cpack` in the build tree: a Debian package of the program, with isotet-reader, man pages and completions; not of the
# libraries for C++. What it depends on is found by dpkg-shlibdeps.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME isotet)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "isosurfaces of very large unstructured grids")
set(CPACK_DEBIAN_PROGRAM_DESCRIPTION
    "isotet extracts, draws and shows isosurfaces, solids and slices of scalar fields on\nunstructured grids, from the files of solvers and mesh generators, on the command\nline and in the browser.")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL program)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME isotet)
set(CPACK_DEBIAN_PACKAGE_MAINTAINER "the isotet authors")
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "libvulkan1, xdg-utils")
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
include(CPack)
