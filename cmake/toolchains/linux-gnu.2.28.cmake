# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# Part of the toolchains ARCHITECTURE-linux-gnu.2.28, which set CMAKE_SYSTEM_PROCESSOR: Linux with glibc 2.28 or later, by the clang of
# tools/zig.sh and the libraries of tools/dependencies.sh: what wheels are made of (tools/wheel.sh).
set(CMAKE_SYSTEM_NAME Linux)
set(triple ${CMAKE_SYSTEM_PROCESSOR}-linux-gnu.2.28)
include("${CMAKE_CURRENT_LIST_DIR}/zig.cmake")
set(CMAKE_EXE_LINKER_FLAGS_INIT -s)
set(CMAKE_SHARED_LINKER_FLAGS_INIT -s)
