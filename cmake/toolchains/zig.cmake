# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# Part of the toolchains by the clang of tools/zig.sh, which set `triple`: its programs, and the libraries of tools/dependencies.sh.
get_filename_component(build "${CMAKE_CURRENT_LIST_DIR}/../../build" ABSOLUTE)
set(CMAKE_C_COMPILER "${build}/zig/bin/${triple}-cc")
set(CMAKE_AR "${build}/zig/bin/zig-ar" CACHE FILEPATH "")
set(CMAKE_RANLIB "${build}/zig/bin/zig-ranlib" CACHE FILEPATH "")
set(CMAKE_FIND_ROOT_PATH "${build}/sysroot/${triple}")
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
set(ENV{PKG_CONFIG_LIBDIR} "${build}/sysroot/${triple}/lib/pkgconfig")
