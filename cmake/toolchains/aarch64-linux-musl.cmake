# SPDX-FileCopyrightText: 2026 The ewa authors
# SPDX-License-Identifier: MIT
#
# 64-bit Arm with musl: one file for every Linux, run under qemu.
set(CMAKE_SYSTEM_PROCESSOR aarch64)
include("${CMAKE_CURRENT_LIST_DIR}/linux-musl.cmake")
set(CMAKE_CROSSCOMPILING_EMULATOR qemu-aarch64-static)
