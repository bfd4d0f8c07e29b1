# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# WebAssembly with WASI and SIMD, by the clang of tools/zig.sh and the libraries of tools/dependencies.sh (make wasm). EWA_RELAXED_SIMD: kernels with
# the multiply-add of hosts that round it once.
list(APPEND CMAKE_MODULE_PATH "${CMAKE_CURRENT_LIST_DIR}")
set(CMAKE_SYSTEM_NAME WASI)
set(CMAKE_SYSTEM_PROCESSOR wasm32)
get_filename_component(build "${CMAKE_CURRENT_LIST_DIR}/../../build" ABSOLUTE)
set(CMAKE_C_COMPILER "${build}/zig/bin/wasm32-wasi-cc")
set(CMAKE_AR "${build}/zig/bin/zig-ar" CACHE FILEPATH "")
set(CMAKE_RANLIB "${build}/zig/bin/zig-ranlib" CACHE FILEPATH "")
set(CMAKE_FIND_ROOT_PATH "${build}/sysroot/wasm32-wasi")
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
set(ENV{PKG_CONFIG_LIBDIR} "${build}/sysroot/wasm32-wasi/lib/pkgconfig")
set(CMAKE_C_FLAGS_INIT "-mcpu=generic+simd128+bulk_memory+nontrapping_fptoint+sign_ext+mutable_globals+multivalue -D_WASI_EMULATED_SIGNAL -D_WASI_EMULATED_PROCESS_CLOCKS -D_WASI_EMULATED_GETPID")
set(CMAKE_EXE_LINKER_FLAGS_INIT "-lwasi-emulated-signal -lwasi-emulated-process-clocks -lwasi-emulated-getpid -Wl,-z,stack-size=4194304 -s")
