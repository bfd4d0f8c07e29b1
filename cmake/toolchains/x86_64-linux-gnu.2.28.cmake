# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# Linux with glibc 2.28 or later on x86-64, by the clang of tools/zig.sh: what wheels are made of (tools/wheel.sh).
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR x86_64)
set(triple x86_64-linux-gnu.2.28)
include("${CMAKE_CURRENT_LIST_DIR}/zig.cmake")
set(CMAKE_SHARED_LINKER_FLAGS_INIT -s)
set(ENV{PKG_CONFIG_LIBDIR} "${build}/sysroot/${triple}/lib/pkgconfig")
