# Options of the build, and what every target of the project is compiled with.

if(PROJECT_IS_TOP_LEVEL AND NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
    set(CMAKE_BUILD_TYPE Release CACHE STRING "Debug, Release, RelWithDebInfo" FORCE)
endif()

option(ISOTET_IO "Read more formats (Exodus, CGNS, VTKHDF, XDMF, ...): build the program isotet-reader, with HDF5 and CGNS" ON)
option(ISOTET_VULKAN "Extract on graphics cards through Vulkan, opened at run time" ON)
option(ISOTET_PROGRAM "Build the program isotet" ${PROJECT_IS_TOP_LEVEL})
option(ISOTET_PYTHON "Build the Python package" OFF)
option(ISOTET_VTK "Build the filter for VTK's pipelines, a VTK module" OFF)
option(ISOTET_TESTS "Build the tests" ${PROJECT_IS_TOP_LEVEL})
option(ISOTET_BENCH "Build the benchmarks" OFF)
option(ISOTET_FUZZ "Build the fuzz targets (clang with libFuzzer)" OFF)
option(ISOTET_WERROR "Warnings are errors" OFF)
option(ISOTET_UNITY "Compile the library in groups of files: half the work; OFF: file by file, for work on it" ON)
set(ISOTET_WEB_MODULE "" CACHE FILEPATH "isotet as WebAssembly, as scripts/web.sh makes it, for isotet export --as grid; empty: none")
set(ISOTET_TEST_KINDS "" CACHE STRING "Folders of tests/ to build; empty: all")
set(ISOTET_TEST_FILTER "" CACHE STRING "Which of their tests to run, as googletest's --gtest_filter; empty: all")
set(ISOTET_TEST_PYTHON "" CACHE FILEPATH "A Python that has the package and what its tests need; empty: they are not run")
set(ISOTET_TEST_PREFIX "" CACHE STRING "What the names of all tests begin with, such as thread.")
set(ISOTET_FUZZ_SECONDS 20 CACHE STRING "How long ctest runs each fuzz target")
set(ISOTET_SANITIZE "" CACHE STRING "Sanitizers to build with: address,undefined or thread")

if(ISOTET_FUZZ)
    if(NOT CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
        message(FATAL_ERROR "ISOTET_FUZZ needs clang with libFuzzer, but the compiler is ${CMAKE_CXX_COMPILER}: "
                            "configure with CC=clang-19 CXX=clang++-19")
    endif()
    set(ISOTET_SANITIZE "address,undefined,fuzzer-no-link")
endif()

set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)

# Contraction is off everywhere: the same bytes on every machine and engine depend on it.
function(isotet_target target)
    target_compile_features(${target} PUBLIC cxx_std_20)
    set_target_properties(${target} PROPERTIES CXX_EXTENSIONS OFF)
    target_compile_options(${target} PRIVATE -ffp-contract=off -Wall -Wextra -Wshadow -Wnon-virtual-dtor -Wpedantic)
    if(ISOTET_UNITY)
        # clang, not g++, takes a local name for a shadow of what another file of the group keeps to itself.
        target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:Clang>:-Wno-shadow>)
    endif()
    if(ISOTET_WERROR)
        # g++ 12 suspects its own AVX-512 intrinsics (GCC bug 105593), strings (GCC bug 105651) and variants that are moved.
        target_compile_options(${target} PRIVATE -Werror
            "$<$<CXX_COMPILER_ID:GNU>:-Wno-error=maybe-uninitialized;-Wno-error=restrict;-Wno-error=free-nonheap-object>"
            $<$<CXX_COMPILER_ID:Clang>:-Wno-error=deprecated-declarations>)
    endif()
    if(ISOTET_SANITIZE)
        target_compile_options(${target} PRIVATE -fsanitize=${ISOTET_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer -g1)
        target_link_options(${target} PUBLIC -fsanitize=${ISOTET_SANITIZE})
        # Checks at every access of what the address sanitizer sees as well: a fifth of the compiler's time.
        if(ISOTET_SANITIZE MATCHES "undefined")
            target_compile_options(${target} PRIVATE -fno-sanitize=null,object-size,pointer-overflow,vptr)
        endif()
        # g++ 12 puts what lies on the address sanitizer's own stack at multiples of 32, and yet moves it by AVX-512
        # instructions that want 64 (GCC bug 110027): there it moves and clears 32 bytes at once.
        if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_GREATER_EQUAL 12 AND
           CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
            target_compile_options(${target} PRIVATE -mprefer-vector-width=256 -mmove-max=256 -mstore-max=256)
        endif()
    endif()
    get_target_property(type ${target} TYPE)
    if(type MATCHES "LIBRARY")
        target_include_directories(${target}
            PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include> $<BUILD_INTERFACE:${PROJECT_BINARY_DIR}/include>
                   $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>
            PRIVATE ${PROJECT_SOURCE_DIR}/src)
        set_target_properties(${target} PROPERTIES VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}
            CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON DEFINE_SYMBOL ""
            UNITY_BUILD ${ISOTET_UNITY} UNITY_BUILD_MODE GROUP)
        if(ISOTET_UNITY)
            # g++ takes what is private to an included file for shared; and it inlines less in what it takes for large.
            target_compile_options(${target} PRIVATE
                "$<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage;--param=large-unit-insns=100000>")
        endif()
    else()
        target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR}/src)
    endif()
endfunction()

# isotet_library(NAME): a library of the project, isotet::isotet or isotet::PART for isotet_PART.
function(isotet_library name)
    string(REPLACE "isotet_" "" part ${name})
    add_library(${name})
    add_library(isotet::${part} ALIAS ${name})
    isotet_target(${name})
    set_target_properties(${name} PROPERTIES EXPORT_NAME ${part})
endfunction()

# isotet_sources(TARGET GROUP FILES...): adds files, which ISOTET_UNITY compiles as one. So names that are private to a
# file must differ from those of the other files of its group.
function(isotet_sources target group)
    target_sources(${target} PRIVATE ${ARGN})
    set_source_files_properties(${ARGN} TARGET_DIRECTORY ${target} PROPERTIES UNITY_GROUP ${group})
endfunction()

# Facts of the build for `isotet --version`.
execute_process(COMMAND git -C ${PROJECT_SOURCE_DIR} rev-parse --short=12 HEAD
    OUTPUT_VARIABLE ISOTET_COMMIT OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
configure_file(${PROJECT_SOURCE_DIR}/cmake/version.hpp.in ${PROJECT_BINARY_DIR}/include/isotet/version.hpp)
