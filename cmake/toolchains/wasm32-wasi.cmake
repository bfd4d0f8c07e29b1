# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# WebAssembly with WASI and SIMD, by the clang of tools/zig.sh and the libraries of tools/dependencies.sh (make wasm). EWA_RELAXED_SIMD: kernels with
# the multiply-add of hosts that round it once.
list(APPEND CMAKE_MODULE_PATH "${CMAKE_CURRENT_LIST_DIR}")
set(CMAKE_SYSTEM_NAME WASI)
set(CMAKE_SYSTEM_PROCESSOR wasm32)
set(triple wasm32-wasi)
include("${CMAKE_CURRENT_LIST_DIR}/zig.cmake")
set(CMAKE_C_FLAGS_INIT "-mcpu=generic+simd128+bulk_memory+nontrapping_fptoint+sign_ext+mutable_globals+multivalue+atomics -D_WASI_EMULATED_SIGNAL -D_WASI_EMULATED_PROCESS_CLOCKS -D_WASI_EMULATED_GETPID")
set(CMAKE_EXE_LINKER_FLAGS_INIT "-lwasi-emulated-signal -lwasi-emulated-process-clocks -lwasi-emulated-getpid -Wl,-z,stack-size=4194304 -s")
