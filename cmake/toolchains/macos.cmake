# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# Part of the toolchains ARCHITECTURE-macos, which set CMAKE_SYSTEM_PROCESSOR and `triple`: macOS by the clang of tools/zig.sh and
# the libraries of tools/dependencies.sh; its programs run on macOS alone (make macos).
set(CMAKE_SYSTEM_NAME Darwin)
set(CMAKE_OSX_SYSROOT "" CACHE PATH "") # zig brings it
include("${CMAKE_CURRENT_LIST_DIR}/zig.cmake")
# In place of the C library's of macOS, whose functions differ by its version; nor are two of them made one, which only it has.
set(CMAKE_EXE_LINKER_FLAGS_INIT "-Wl,-force_load,${build}/sysroot/${triple}/lib/libmusl_math.a -s")
set(CMAKE_SHARED_LINKER_FLAGS_INIT "${CMAKE_EXE_LINKER_FLAGS_INIT}")
set(CMAKE_C_FLAGS_INIT "-fno-builtin-sin -fno-builtin-cos -fno-builtin-pow")
# No path of this machine: who loads the library says where it is.
set(CMAKE_INSTALL_NAME_DIR "@rpath")
set(CMAKE_BUILD_WITH_INSTALL_NAME_DIR ON)
