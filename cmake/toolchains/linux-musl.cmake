# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# Part of the toolchains ARCHITECTURE-linux-musl, which set CMAKE_SYSTEM_PROCESSOR: static programs by the clang of tools/zig.sh.
set(CMAKE_SYSTEM_NAME Linux)
get_filename_component(build "${CMAKE_CURRENT_LIST_DIR}/../../build" ABSOLUTE)
set(CMAKE_C_COMPILER "${build}/zig/bin/${CMAKE_SYSTEM_PROCESSOR}-linux-musl-cc")
set(CMAKE_AR "${build}/zig/bin/zig-ar" CACHE FILEPATH "")
set(CMAKE_RANLIB "${build}/zig/bin/zig-ranlib" CACHE FILEPATH "")
set(CMAKE_FIND_ROOT_PATH "${build}/sysroot/${CMAKE_SYSTEM_PROCESSOR}-linux-musl")
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
set(CMAKE_EXE_LINKER_FLAGS_INIT "-static -s")
