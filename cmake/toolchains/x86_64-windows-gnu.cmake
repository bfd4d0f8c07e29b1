# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# Windows on x86-64 with its universal C runtime, by the clang of tools/zig.sh and the libraries of tools/dependencies.sh; programs
# run under wine (make windows).
set(CMAKE_SYSTEM_NAME Windows)
set(CMAKE_SYSTEM_PROCESSOR x86_64)
set(triple x86_64-windows-gnu)
include("${CMAKE_CURRENT_LIST_DIR}/zig.cmake")
set(CMAKE_RC_COMPILER "${build}/zig/bin/zig-rc" CACHE FILEPATH "")
# Before the C runtime of Windows, whose functions differ by its version.
set(CMAKE_EXE_LINKER_FLAGS_INIT "${build}/sysroot/${triple}/lib/libmusl_math.a -s")
set(CMAKE_SHARED_LINKER_FLAGS_INIT "${CMAKE_EXE_LINKER_FLAGS_INIT}")
set(CMAKE_CROSSCOMPILING_EMULATOR "sh;${CMAKE_CURRENT_LIST_DIR}/../../tools/wine.sh")
