# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# Linux with glibc 2.28 or later on 64-bit Arm; its programs run under qemu with the C library of tools/sysroot.sh (make arm64).
set(CMAKE_SYSTEM_PROCESSOR aarch64)
include("${CMAKE_CURRENT_LIST_DIR}/linux-gnu.2.28.cmake")
set(CMAKE_CROSSCOMPILING_EMULATOR "qemu-aarch64-static;-L;${build}/sysroot/arm64")
