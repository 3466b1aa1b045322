# Copyright (c) the isotet authors. SPDX-License-Identifier: BSD-3-Clause
# WebAssembly by Debian's clang-19, with the libraries of libc++-19-dev-wasm32 and wasi-libc: one thread, SIMD of 128 bits, no
# exceptions (what throws ends the module). Sizes have 32 bits: numbers in braces may be cut to them, and all are below 2^32.
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR wasm32)
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
set(CMAKE_TRY_COMPILE_PLATFORM_VARIABLES ISOTET_WASM_ROOT)
set(CMAKE_CXX_COMPILER clang++-19)
set(CMAKE_CXX_COMPILER_TARGET wasm32-wasi)
set(CMAKE_C_COMPILER clang-19)
set(CMAKE_C_COMPILER_TARGET wasm32-wasi)

set(ISOTET_WASM_ROOT "" CACHE PATH "Where the packages are unpacked; empty: they are installed")
set(llvm ${ISOTET_WASM_ROOT}/usr/lib/llvm-19)
set(CMAKE_CXX_FLAGS_INIT "-nostdinc -nostdinc++ -isystem ${CMAKE_CURRENT_LIST_DIR}/../src/web/portable \
-isystem ${llvm}/include/wasm32-wasi/c++/v1 -isystem /usr/lib/llvm-19/lib/clang/19/include \
-isystem ${ISOTET_WASM_ROOT}/usr/include/wasm32-wasi -msimd128 -fignore-exceptions -Wno-c++11-narrowing \
-Wno-tautological-constant-out-of-range-compare")
set(CMAKE_C_FLAGS_INIT "-nostdinc -isystem /usr/lib/llvm-19/lib/clang/19/include \
-isystem ${ISOTET_WASM_ROOT}/usr/include/wasm32-wasi -msimd128")
set(CMAKE_EXE_LINKER_FLAGS_INIT "-nostdlib -mexec-model=reactor -fuse-ld=${llvm}/bin/wasm-ld \
-L${llvm}/lib/wasm32-wasi -L${ISOTET_WASM_ROOT}/usr/lib/wasm32-wasi")
set(ISOTET_WASM_LIBRARIES c++ c++abi c wasi-emulated-mman wasi-emulated-process-clocks
    ${llvm}/lib/clang/19/lib/wasi/libclang_rt.builtins-wasm32.a)
set(ISOTET_WASM_START ${ISOTET_WASM_ROOT}/usr/lib/wasm32-wasi/crt1-reactor.o)
