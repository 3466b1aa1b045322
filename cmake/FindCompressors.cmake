# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
# libdeflate, liblz4 and liblzma, which Debian ships without files for CMake: Compressors::all, and Compressors_FOUND.
find_path(Compressors_deflate_INCLUDE_DIR libdeflate.h)
find_path(Compressors_lz4_INCLUDE_DIR lz4.h)
find_path(Compressors_lzma_INCLUDE_DIR lzma.h)
find_library(Compressors_deflate_LIBRARY deflate)
find_library(Compressors_lz4_LIBRARY lz4)
find_library(Compressors_lzma_LIBRARY lzma)
set(compressors_needed Compressors_deflate_LIBRARY Compressors_lz4_LIBRARY Compressors_lzma_LIBRARY
    Compressors_deflate_INCLUDE_DIR Compressors_lz4_INCLUDE_DIR Compressors_lzma_INCLUDE_DIR)
mark_as_advanced(${compressors_needed})

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(Compressors REQUIRED_VARS ${compressors_needed})

if(Compressors_FOUND AND NOT TARGET Compressors::all)
    add_library(Compressors::all INTERFACE IMPORTED)
    set_target_properties(Compressors::all PROPERTIES
        INTERFACE_INCLUDE_DIRECTORIES "${Compressors_deflate_INCLUDE_DIR};${Compressors_lz4_INCLUDE_DIR};${Compressors_lzma_INCLUDE_DIR}"
        INTERFACE_LINK_LIBRARIES "${Compressors_deflate_LIBRARY};${Compressors_lz4_LIBRARY};${Compressors_lzma_LIBRARY}")
endif()
